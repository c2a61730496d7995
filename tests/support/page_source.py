"""What the page's own code makes of values, without a browser."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "tests" / "support" / "page_parser.mjs"
SOURCES = ROOT / "tools" / "service_page" / "src"
PACKAGES = ROOT / "build" / "service_page" / "node_modules"
ESBUILD = PACKAGES / "esbuild" / "lib" / "main.js"


def ask_source(
    source: str | Path, asked: Sequence[Sequence[Any]], names: Mapping[str, Any] | None = None
) -> list[Any]:
    """What functions of a file return; bytes go as hex, and `names` follows the arguments."""
    coded = [
        [{"hex": each.hex()} if isinstance(each, bytes) else each for each in one] for one in asked
    ]
    node = Path(sys.executable).with_name("node")
    told = subprocess.check_output(
        [node, SCRIPT, ESBUILD, SOURCES / source],
        input=json.dumps({"names": names or {}, "asked": coded}),
        text=True,
    )
    answers: list[Any] = json.loads(told)
    return answers
