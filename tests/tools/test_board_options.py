"""`board options`: old and new are shown first, and nothing is written without a yes."""

from __future__ import annotations

import io
import os
import re
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from rkm04_tools import board, board_options
from rkm04_tools.failure import NO_CONNECTION, NOT_SO

ROOT = Path(__file__).resolve().parents[2]
FAKE = """#!/bin/sh
cd {folder}
echo "$*" >>calls
case "$*" in
*mww*)
    echo '0x40023c0c: {status:08x} '
    echo '0x40023c14: {after:08x} ' ;;
*) echo '0x40023c14: {before:08x} ' ;;
esac
"""
DELIVERED, LEVEL_3, LEVEL_2, PROTECTED = 0x0FFFAAED, 0x0FFFAAE1, 0x0FFFAAE5, 0x0FFF55ED

Part = Callable[..., Path]


@pytest.fixture
def part(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Part:
    """A part that has these option bytes before and after a write."""
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")

    def make(before: int, after: int = 0, status: int = 0) -> Path:
        tool = tmp_path / "openocd"
        tool.write_text(FAKE.format(folder=tmp_path, before=before, after=after, status=status))
        tool.chmod(0o755)
        return tmp_path / "calls"

    return make


def writes(calls: Path) -> list[str]:
    return re.findall(r"mww (\S+ \S+);", calls.read_text())


def test_the_level_of_the_board_is_set_and_all_else_stays(tool, part):
    calls = part(DELIVERED, LEVEL_3)
    result = tool("board", "options", "--yes")

    assert result.status == 0
    assert writes(calls) == [
        "0x40023c08 0x08192a3b", "0x40023c08 0x4c5d6e7f", "0x40023c14 0x0fffaae0",
        "0x40023c14 0x0fffaae2", "0x40023c14 0x0fffaae1",
    ]  # fmt: skip
    now, new = result.out.index("reset now: off"), result.out.index("reset new: level 3")
    assert now < new < result.out.index("written")
    assert "pins float" in result.out


def test_another_board_has_another_level(tool, part):
    part(DELIVERED, LEVEL_2)
    result = tool("board", "options", "--board", "f407-discovery", "--yes", "--json")

    assert result.json == {"board": "f407-discovery", "option_bytes": "0fffaae5", "written": True}


def test_without_a_yes_nothing_is_written(tool, part):
    calls = part(DELIVERED, LEVEL_3)
    result = tool("board", "options")

    assert result.status == NOT_SO
    assert "reset new: level 3" in result.out
    assert "nothing was written" in result.err
    assert writes(calls) == []


@pytest.mark.parametrize(
    ("answer", "written"), [("y\n", True), ("n\n", False), ("\n", False), ("", False)]
)
def test_at_a_terminal_it_asks(tool, part, monkeypatch, answer, written):
    calls = part(DELIVERED, LEVEL_3)
    typed = io.StringIO(answer)
    monkeypatch.setattr(typed, "isatty", lambda: True)
    monkeypatch.setattr(sys, "stdin", typed)
    result = tool("board", "options")

    assert result.status == (0 if written else NOT_SO)
    assert "Are the motors unpowered" in result.out
    assert bool(writes(calls)) == written


def test_what_is_so_already_is_not_written(tool, part):
    calls = part(LEVEL_3)
    result = tool("board", "options", "--yes")

    assert (result.status, result.out.splitlines()[-1]) == (0, "nothing to do")
    assert writes(calls) == []


@pytest.mark.parametrize("before", [PROTECTED, 0, 0xFFFFFFFF, 0x0FFFCCED])
def test_bytes_that_cannot_be_right_are_left_alone(tool, part, before):
    calls = part(before)
    result = tool("board", "options", "--yes")

    assert result.status == NOT_SO
    assert "nothing was written" in result.complaint
    assert writes(calls) == []


@pytest.mark.parametrize(
    ("after", "status"), [(DELIVERED, 0), (LEVEL_3, 1 << 16), (0x0FFFAAE0 ^ 1 << 16, 0)]
)
def test_a_write_that_has_not_come_true_is_told(tool, part, after, status):
    part(DELIVERED, after, status)
    result = tool("board", "options", "--yes")

    assert result.status == NOT_SO
    assert "not what was written" in result.err


@pytest.mark.parametrize(
    ("name", "level", "allowed"),
    [("f407-discovery", "3", False), ("f407-discovery", "2", True), ("f405", "3", True)],
)
def test_a_level_at_which_the_board_might_never_start_is_refused(tool, part, name, level, allowed):
    calls = part(DELIVERED, LEVEL_3 if level == "3" else LEVEL_2)
    result = tool("board", "options", "--board", name, "--level", level, "--yes")

    assert result.status == (0 if allowed else NOT_SO)
    assert calls.exists() == allowed
    assert ("it might never start again" in result.err) == (not allowed)


def test_off_is_a_level_too(tool, part):
    calls = part(LEVEL_3, DELIVERED)

    assert tool("board", "options", "--level", "off", "--yes").status == 0
    assert "0x40023c14 0x0fffaaee" in writes(calls)


def test_a_dry_run_asks_no_board(tool, part):
    calls = part(DELIVERED)
    result = tool("board", "options", "--dry-run", "--json").json

    assert result["look"][0] == result["command"][0] == "openocd"
    assert "mww" not in result["look"][-1]
    assert not calls.exists()


def test_a_board_that_is_not_there_is_told(tool, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    (tmp_path / "openocd").write_text("#!/bin/sh\necho 'Error: open failed' >&2; exit 1\n")
    (tmp_path / "openocd").chmod(0o755)
    result = tool("board", "options", "--yes")

    assert result.status == NO_CONNECTION
    assert "openocd finds no board" in result.complaint


def test_the_thresholds_are_those_that_the_firmware_is_checked_against():
    text = (ROOT / "hal" / "stm32" / "stm32_supply.h").read_text()
    macro = text[text.index("STM32_BROWN_OUT_RISING_MAX_MV") :].partition("\n#define")[0]
    found = re.findall(r"== (\d)U \? (\d+)U", macro)

    assert len(found) == 3
    assert all(board_options.RISING_MAX_MV[level] == int(mv) for level, mv in found)
    for level, (_, starts) in board_options.VOLTS.items():
        assert starts.endswith(f"{board_options.RISING_MAX_MV[level] / 1000:.2f}")


@pytest.mark.parametrize("name", board.names())
def test_every_board_says_which_level_it_wants(tool, name):
    assert tool("board", "options", "--board", name, "--dry-run").status == 0
