"""The sources of the page, as the set-up has built them."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

BUILD = Path(__file__).resolve().parents[2] / "build"
NODE = BUILD / "venv/bin/node"
COPY = BUILD / "service_page"


@pytest.mark.skipif(not (COPY / "node_modules").exists(), reason="the page was built elsewhere")
def test_the_type_checker_has_nothing_to_say():
    done = subprocess.run(
        [NODE, "node_modules/typescript/bin/tsc", "--noEmit"],
        cwd=COPY, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.stdout + done.stderr == ""
    assert done.returncode == 0
