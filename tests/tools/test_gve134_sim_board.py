"""`gve134 sim --target stm32` plays a vector file to the image of a board as it is played to the
simulated unit."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from gve_sim import Play, Played, player, pulses_of
from rkm04_tools import virtual_board
from rkm04_tools.gve134 import sim_board

ROOT = Path(__file__).resolve().parents[2]
TICKS_PER_MS = 84_000
BEGAN_TICK = 50 * TICKS_PER_MS
COUNTS = ("commands", "vectors", "unanswered", "refused", "ended", "stuck")

PACKET = ["*S", "C300,40", "C0,-200", "C-500,100,7,1", "*E3"]
COURSES = {
    "checksums, which J ends": "%+\nV1000\nL10,-5\nP4\nL0,0,0,0\nP4\nJ\nP4\nL7\nL0,0,0,0\nP4\n",
    "checksums, which are switched off": "%+\nL3\n?\n%-\n>\n@\n",
    "H beside a command that waits": "V2000\nL2000\n@30 H\n;@wait 0.4\nF\nD\nSR0\nF\n",
    "J beside a command that waits": "V1000\nL1000\n@40 H\n@50 J\nP4\nL20\nL0,0,0,0\nP4\n",
    "more vectors than there is room": "V2000\n" + "C10,3\n" * 140 + "L0,0,0,0\nP4\n",
    "packets without room": "V2000\n" + ("*S\n" + "C9,2\n" * 60 + "*E60\n") * 3 + "L0,0,0,0\nP4\n",
    "a packet that H ends": "*S\nC10\nH\nP4\n",
    "refusals": "G\nV100\nL20\nK\n@20 F\n",
    "what is asked of the host": "L5\n;@wait 0.2\n;@pause look\nP4\nF\n",
    "the spindle and outputs": "!7V300\nO0,FE\nI1\n@10 !7V20\n@5 P4\n",
    "no line": "; nothing\n",
}


@pytest.fixture
def play(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Play:
    """Play a text to the simulated unit, or to a board."""

    def read() -> tuple[str, str]:
        told = capsys.readouterr()
        return told.out, told.err

    return player(tmp_path, read)


@pytest.fixture
def on_board(play: Play) -> Callable[..., Played]:
    """Play a text to the board, where there is a virtual one."""
    build = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host")
    if not (build / "bin" / virtual_board.PROGRAM).is_file():
        pytest.skip("the virtual board is not built: libunicorn or libcapstone is missing")
    return lambda text, *options: play(text, "--target", "stm32", *options)


@pytest.mark.parametrize("course", COURSES)
def test_the_board_is_played_to_and_answers_as_the_simulator(play, on_board, course):
    simulated = play(COURSES[course], "--json", "--baud", "115200")
    modelled = on_board(COURSES[course], "--json")

    assert modelled.status == simulated.status
    assert modelled.answers == simulated.answers
    assert [modelled.json[name] for name in COUNTS] == [simulated.json[name] for name in COUNTS]
    assert modelled.json["late_steps"] == 0


def test_a_packet_has_the_ticks_of_the_simulator(play, on_board, tmp_path):
    ours, theirs = tmp_path / "board.csv", tmp_path / "simulated.csv"
    text = ["V20000", "A400", *PACKET]

    play(text, "--steps", theirs)
    told = on_board(text, "--steps", ours, "--vcd", tmp_path / "board.vcd", "--json").json

    made, wanted = (np.array(pulses_of(path), dtype=np.int64) for path in (ours, theirs))
    assert ours.read_text().splitlines()[:2] == theirs.read_text().splitlines()[:2]
    assert len(wanted) == 800 + 340 + 7 + 1
    for rows in (made, wanted):
        rows[:, 0] -= rows[0, 0]
    assert sorted(map(tuple, made)) == sorted(map(tuple, wanted))
    assert [axis["pulses"] for axis in told["axes"]] == [800, 340, 7, 1]
    assert "$var wire 1" in (tmp_path / "board.vcd").read_text()


def test_the_table_tells_pulses_load_and_late_steps(on_board):
    played = on_board(["V1000", "L100,-50", "P"])

    assert (played.status, played.err) == (0, "")
    assert played.lines[0] == "a.gve:3: P: 0,0,0"
    assert played.lines[3].split() == ["X", "100", "100", "100"]
    assert played.lines[4].split() == ["Y", "50", "50", "-50"]
    assert re.search(r"^load [\d.]+ %, late steps: 0$", played.out, re.MULTILINE)
    assert re.search(r"^step interrupt: [\d ]+ times, cycles \d+ at least", played.out, re.M)
    assert played.out.endswith(f"{virtual_board.MODEL}\n")


def test_times_of_the_file_and_of_inputs_count_from_its_first_line(on_board, tmp_path):
    inputs, steps = tmp_path / "inputs.csv", tmp_path / "steps.csv"
    inputs.write_text("# ms,input,level\n100,1,0\n")

    played = on_board("SW0,01\nV1000\n@40 L1000\n", "--inputs", inputs, "--steps", steps, "--json")

    ticks = [tick - BEGAN_TICK for tick, *_ in pulses_of(steps)]
    assert 40 < ticks[0] / TICKS_PER_MS < 60
    assert played.json["axes"][0]["pulses"] == len(ticks) < 1000
    assert 99 < ticks[-1] / TICKS_PER_MS < 250


def test_a_limit_of_time_is_told_with_the_line_that_has_no_answer(on_board):
    played = on_board("V1000\nL5000\nL7\n@100 P4\n", "--for", "0.2", "--json")

    assert played.json["ended"] == "time"
    assert played.json["stuck"] == {"line": 3, "command": "L7,0,0,0", "reason": "no_room"}


def test_levels_are_those_of_closed_inputs_on_the_virtual_board():
    assert sim_board.levels(b"# 1,1,1\n5,1,0\n6.25 , 7 , 1\n") == b"# 1,1,1\n5,1,1\n6.25 , 7 , 0\n"


@pytest.mark.parametrize("option", ["--trace", "--plot", "--xy"])
def test_what_the_board_cannot_tell_is_refused(play, tmp_path, option):
    played = play("L1\n", "--target", "stm32", option, tmp_path / "out.svg")

    assert played.status == 2
    assert played.err == f"gve134: {option}: not with --target stm32; leave one of the two away\n"


@pytest.mark.parametrize(
    ("text", "options", "told"),
    [
        ("F\nL1\n;@probe\n", ["--target", "stm32"], "a.gve:3: ;@probe: not with --target stm32"),
        (
            "L1\n",
            ["--target", "stm32", "--baud", "40000"],
            "--baud 40000: images for --target stm32",
        ),
        ("L1\n", ["--target", "stm32", "--board", "none"], "none: no such board"),
        ("L1\n", ["--board", "f405"], "--board needs --target stm32"),
    ],
)
def test_what_has_no_meaning_there_is_refused(play, text, options, told):
    played = play(text, *options)

    assert (played.status, played.out) == (2, "")
    assert told in played.err
    assert played.err.count("\n") == 1


def test_an_error_of_the_file_is_told_before_anything_is_built(play):
    played = play("L1\nX\n", "--target", "stm32")

    assert played.status == 1
    assert "a.gve:2:1: error" in played.err


def test_bad_inputs_are_told_as_the_simulator_does(on_board, tmp_path):
    inputs = tmp_path / "inputs.csv"
    inputs.write_text("5,9,1\n")

    played = on_board("L1\n", "--inputs", inputs)

    assert played.status != 0
    assert "inputs.csv:1" in played.err
