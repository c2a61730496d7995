"""`sim --target stm32` runs programs on the virtual board and says what that took."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from rkm04_tools import sim_board, virtual_board
from rkm04_tools.check import check_source
from rkm04_tools.source import read_source

ROOT = Path(__file__).resolve().parents[2]
TICKS_PER_MS = 84_000


@pytest.fixture
def board_tool(tool):
    """The command, where there is a virtual board."""
    build = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host")
    if not (build / "bin" / virtual_board.PROGRAM).is_file():
        pytest.skip("the virtual board is not built: libunicorn or libcapstone is missing")

    def run(*arguments):
        return tool("sim", "--target", "stm32", *arguments)

    return run


def test_the_table_tells_pulses_load_and_cycles(board_tool, write):
    result = board_tool(write("S500 F300 R D R"))

    assert (result.status, result.err) == (0, "")
    assert result.out.splitlines()[1].split()[-3:] == ["600", "600", "0"]
    assert "late steps: 0" in result.out
    assert re.search(r"step interrupt: [\d ]+ times, cycles \d+ at least", result.out)
    assert result.out.endswith("modelled: P = 3, 5 wait states\n")


def test_programs_that_begin_with_a_reset_are_released_together(board_tool, write, tmp_path):
    one, other = write("\\ S100 F20 R", "1.rks"), write("{ first } \\C100 S100 B20 R", "2.rks")
    steps = tmp_path / "steps.csv"

    result = board_tool(one, "--motor", f"3={other}", "--steps", steps, "--json")

    rows = [tuple(map(int, row.split(","))) for row in steps.read_text().splitlines()[2:]]
    assert [(m["motor"], m["pulses"], m["position"]) for m in result.json["motors"]] == [
        (1, 20, 20),
        (3, 20, -20),
    ]
    assert [t for t, motor, _ in rows if motor == 1] == [t for t, motor, _ in rows if motor == 3]


def test_inputs_count_from_the_time_at_which_programs_have_come(board_tool, write, tmp_path):
    program = write("S100 O02 F10 R")
    inputs = write("# ms,input,level\n100,2,1\n", "inputs.csv")

    steps = tmp_path / "steps.csv"

    result = board_tool(program, "--inputs", inputs, "--steps", steps, "--json")

    ticks = [int(row.split(",")[0]) for row in steps.read_text().splitlines()[2:]]
    behind_ms = ticks[0] / TICKS_PER_MS - result.json["began_ms"]
    assert len(ticks) == 10
    assert 100 < behind_ms < 120


def test_only_changes_after_the_start_are_put_later():
    told = sim_board.later(b"# ms\n0,6,1\n2.5,3,1 # a\n\nnonsense\n", 100)

    assert told == b"# ms\n0,6,1\n102.500000,3,1 # a\n\nnonsense\n"


def test_an_error_of_a_program_is_told_with_its_place(board_tool, write):
    result = board_tool(write("F10 R\nJ5"))

    assert result.status == 1


@pytest.mark.parametrize("option", ["--trace", "--plot"])
def test_what_the_board_cannot_tell_is_refused(tool, write, tmp_path, option):
    result = tool("sim", "--target", "stm32", write("F10 R"), option, tmp_path / "out.svg")

    assert result.status == 2
    assert (
        result.complaint == f"rkm04: {option}: not with --target stm32; leave one of the two away"
    )


def test_without_the_virtual_board_the_hint_names_its_libraries(tool, write, monkeypatch):
    monkeypatch.setattr(virtual_board, "PROGRAM", "no-such-board")

    result = tool("sim", "--target", "stm32", write("F10 R"))

    assert result.status == 2
    assert "libunicorn-dev" in result.complaint


def test_a_program_is_held_after_its_last_reset(write):
    checked = check_source(read_source(write("F1 \\ S100 \\ F2 R")))

    assert sim_board.message(checked, alone=False) == b"F1 \\ S100 \\[ F2 R"
    assert sim_board.message(checked, alone=True) == b"F1 \\ S100 \\ F2 R"
