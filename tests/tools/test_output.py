"""Standard output and standard error that are full or closed: one line, and nothing half done."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from fake_unit import MOVING, RUNNING, FakeUnit

ROOT = Path(__file__).resolve().parents[2]
TOOLS = {
    "rkm04": "rkm04_tools",
    "gve134": "rkm04_tools.gve134",
    "positioning": "rkm04_tools.positioning",
}
FULL, CLOSED = ">/dev/full", ">&-"
LOST = {
    FULL: r"cannot be written \(no space left on device\)",
    CLOSED: "is closed",
}

Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Run a tool by a shell that redirects its streams."""

    def run(
        command: str, redirected: str, tool: str = "rkm04", unbuffered: bool = False
    ) -> subprocess.CompletedProcess[str]:
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "tools")}
        environment.pop("PYTHONUNBUFFERED", None)
        if unbuffered:
            environment["PYTHONUNBUFFERED"] = "1"
        return subprocess.run(
            ["sh", "-c", f"exec {sys.executable} -P -m {TOOLS[tool]} {command} {redirected}"],
            capture_output=True, text=True, cwd=tmp_path, env=environment, timeout=60,
        )  # fmt: skip

    return run


@pytest.mark.parametrize("unbuffered", [False, True])
@pytest.mark.parametrize("redirected", [FULL, CLOSED])
@pytest.mark.parametrize("command", ["--help", "board pins"])
@pytest.mark.parametrize("tool", TOOLS)
def test_a_lost_answer_is_one_line_and_status_2(run, tool, command, redirected, unbuffered):
    result = run(command, redirected, tool, unbuffered)

    assert (result.returncode, result.stdout) == (2, "")
    assert re.fullmatch(
        rf"{tool}: standard output {LOST[redirected]}: the answer is lost, though what was asked "
        r"for may be done\n", result.stderr,
    )  # fmt: skip


@pytest.mark.parametrize("redirected", [FULL, CLOSED])
def test_the_status_of_a_command_that_fails_stays_with_a_lost_answer(run, write, redirected):
    result = run(f"check {write('Q')}", redirected)

    assert result.returncode == 1
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize("redirected", [">/dev/full 2>/dev/full", ">&- 2>&-", ">&- 2>&- <&-"])
def test_a_stop_is_sent_though_nothing_of_it_can_be_told(run, fake, unit, redirected):
    unit.states = [MOVING | RUNNING, 0, 0, 0]

    result = run("stop", redirected)

    assert (result.returncode, result.stdout, result.stderr) == (2, "", "")
    assert b"\x020K" in unit.done


@pytest.mark.parametrize("redirected", ["2>/dev/full", "2>&-"])
def test_a_complaint_that_cannot_be_told_changes_no_status(run, redirected):
    result = run("version --port socket://127.0.0.1:9", redirected)

    assert (result.returncode, result.stdout, result.stderr) == (3, "", "")


@pytest.fixture
def unit() -> FakeUnit:
    return FakeUnit()
