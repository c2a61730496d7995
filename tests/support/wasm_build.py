"""Builds the programs for WebAssembly and runs them; several processes may ask at the same time."""

from __future__ import annotations

import fcntl
import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "wasm"
LOCK = ROOT / "build" / "rkm04.lock"
"""That of tools/rkm04, which builds there, too."""
COMMANDS = (["cmake", "--preset", "wasm"], ["cmake", "--build", "--preset", "wasm"])


def build_wasm() -> Path:
    """Return the folder of the programs. The first time the compiler makes its library, too."""
    BUILD.mkdir(parents=True, exist_ok=True)
    with LOCK.open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        for command in COMMANDS:
            done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stdout + done.stderr
    return BUILD / "bin"


def run_all(jobs: Sequence[dict[str, Any]]) -> list[int]:
    """Run them in one process; their exit statuses."""
    node = Path(sys.executable).with_name("node")
    command: list[str | Path] = [node, "--no-warnings", ROOT / "tests/support/wasm_run.mjs"]
    out = subprocess.check_output(command, input=json.dumps(jobs), text=True)
    statuses: list[int] = json.loads(out)
    return statuses
