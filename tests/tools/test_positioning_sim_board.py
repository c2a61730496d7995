"""`positioning sim --target stm32` plays a script to the image of a board, over its line, as it is
played to the simulated unit."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gve_sim import pulses_of
from rkm04_tools import virtual_board
from rkm04_tools.failure import Failure
from rkm04_tools.positioning import frames, modbus
from rkm04_tools.positioning.board_player import Player
from rkm04_tools.positioning.board_script import lines_of, requests_of

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "tools/examples/positioning"
TICKS_PER_MS = 84_000
BEGAN_TICK = 50 * TICKS_PER_MS
REST_TICKS = 100 * TICKS_PER_MS
"""Between two motions; pulses of a motion are closer."""
SPREAD_MS = 1.0
"""By which the times from one request to the next may differ, as frames differ in length."""
MOVE = "0,1,POS_INIT\n20,1,POS_MODE,1000,500\n40,1,POS_CONTROL,1000mm/min,1\n"

REFUSED = """\
0,1,POS_MODE,5,5
1,0,SETTING,31,5
2,1,POS_INIT,7
2,0,SETTING,103,5
2,0,SETTING,131,5
2,0,SETTING,501,6553600
2,0,SETTING,146,-70000
2,0,SETTING,146,-9
2,0,SETTING,147,-8
2,0,SETTING,700,1
2,0,SETTING,110,1
3,2,POS_INIT
3,1,POS_CONTROL,5mm/min
3,2,POS_CONTROL,0,0
3,0,SETTING,232,5
3,1,POS_CAPTURE
3,1,POS_RESET
4,2,POS_HOME,5,0,500
4,2,POS_HOME,37,-777,0
5,0,SETTING,40,1
6,2,POS_MODE,-2147483648,5
6,2,POS_MODE,5,0
200,2,READ
"""

Play = Callable[..., Any]


@pytest.fixture
def play(positioning: Play, tmp_path: Path) -> Play:
    """Play a text, or a file, to the simulated unit."""
    path = tmp_path / "a.csv"

    def run(script: str | Path, *options: str | Path) -> Any:
        path.write_text(script if isinstance(script, str) else script.read_text())
        return positioning("sim", path, *options)

    return run


@pytest.fixture
def on_board(play: Play) -> Play:
    """Play it to the board, where there is a virtual one."""
    build = Path(os.environ.get("RKM04_BUILD") or ROOT / "build" / "host")
    if not (build / "bin" / virtual_board.PROGRAM).is_file():
        pytest.skip("the virtual board is not built: libunicorn or libcapstone is missing")
    return lambda script, *options: play(script, "--target", "stm32", *options)


def told(answer: Any) -> list[tuple[int, str, int]]:
    """Line, instruction and result of what is told."""
    return [(each["line"], each["instruction"], each["result"]) for each in answer.json["told"]]


def motions(steps: Path, axis: int = 1) -> list[np.ndarray]:
    """The ticks of each motion, from its first pulse on."""
    ticks = np.array([tick for tick, number, _ in pulses_of(steps) if number == axis])
    ends = [0, *(np.flatnonzero(np.diff(ticks) > REST_TICKS) + 1), len(ticks)]
    return [ticks[a:b] - ticks[a] for a, b in pairwise(ends)]


def both(play: Play, on_board: Play, folder: Path, script: str | Path, *options: Path | str) -> Any:
    """What the simulator and the board tell, and their steps files."""
    files = [folder / f"{name}-steps.csv" for name in ("simulator", "board")]
    runs = (play, on_board)
    answers = [
        run(script, "--json", "--steps", file, *options)
        for run, file in zip(runs, files, strict=True)
    ]
    assert answers[1].json["late_steps"] == 0
    return *answers, *files


def test_a_move_with_another_feed_on_its_way_has_the_pulses_of_the_simulator(
    play, on_board, tmp_path
):
    script = EXAMPLES / "first-move.csv"

    simulated, modelled, theirs, ours = both(play, on_board, tmp_path, script)

    assert (simulated.status, modelled.status) == (0, 0)
    [wanted], [made] = motions(theirs), motions(ours)
    assert len(made) == len(wanted) == 1000
    assert np.max(np.abs(made - wanted)) < SPREAD_MS * TICKS_PER_MS
    until = np.searchsorted(wanted, 370 * TICKS_PER_MS)
    assert until > 500
    assert np.array_equal(made[:until], wanted[:until])
    assert modelled.json["axes"][0]["position_um"] == 10_000
    assert modelled.json["behind_ms"] == 0


def test_a_hold_keeps_what_is_left_of_the_measure(play, on_board, tmp_path):
    simulated, modelled, theirs, ours = both(play, on_board, tmp_path, EXAMPLES / "hold.csv")

    assert [axis["position"] for axis in modelled.json["axes"]] == [2500, -1250, 0, 0]
    assert told(modelled) == told(simulated) == [(9, "READ", 0)]
    assert modelled.json["told"][0]["status"] == simulated.json["told"][0]["status"]
    assert 10_000 < modelled.json["told"][0]["position_um"] < 13_000
    [wanted], [made] = motions(theirs, 2), motions(ours, 2)
    assert np.array_equal(made, wanted)
    for wanted, made in zip(motions(theirs), motions(ours), strict=True):
        ramp = 700
        assert np.array_equal(made[:ramp], wanted[:ramp])


def test_homing_ends_on_the_switch_of_the_inputs(play, on_board, tmp_path):
    inputs = EXAMPLES / "home-inputs.csv"

    simulated, modelled, theirs, ours = both(
        play, on_board, tmp_path, EXAMPLES / "home.csv", "--inputs", inputs
    )

    assert (modelled.status, modelled.json["ended"]) == (0, "idle")
    shown = [{**each, "tick": 0} for each in modelled.json["told"]]
    assert shown[0]["position_um"] == simulated.json["told"][0]["position_um"] == 0
    assert shown[0]["status"] == simulated.json["told"][0]["status"]
    assert modelled.json["axes"][0]["position_um"] == 20_000
    assert abs(modelled.json["axes"][0]["pulses"] - simulated.json["axes"][0]["pulses"]) < 30
    assert np.array_equal(motions(ours)[-1], motions(theirs)[-1])


def test_axes_whose_feeds_come_at_the_same_time_begin_on_the_same_tick(play, on_board, tmp_path):
    axes = range(1, 5)
    script = "".join(f"0,{axis},POS_INIT\n" for axis in axes)
    script += "".join(f"40,{axis},POS_MODE,{-300 * axis},{100 * axis}\n" for axis in axes)
    script += "100,1,POS_CONTROL,900mm/min\n"
    script += "".join(f"100,{axis},POS_CONTROL,58982400,1\n" for axis in axes if axis > 1)
    waves = tmp_path / "board.vcd"

    _, modelled, theirs, ours = both(play, on_board, tmp_path, script)
    on_board(script, "--vcd", waves, "--for", "0.02")

    made, wanted = (np.array(pulses_of(path), dtype=np.int64) for path in (ours, theirs))
    for rows in (made, wanted):
        rows[:, 0] -= rows[0, 0]
    assert sorted(map(tuple, made)) == sorted(map(tuple, wanted))
    assert [axis["pulses"] for axis in modelled.json["axes"]] == [30, 60, 90, 120]
    assert ours.read_text().splitlines()[:2] == theirs.read_text().splitlines()[:2]
    assert "$var wire 1" in waves.read_text()


def test_settings_count_and_the_same_instruction_twice_is_executed_twice(play, on_board):
    script = "0,0,SETTING,130,3\n0,0,SETTING,134,1\n0,0,SETTING,138,6553600\n" + MOVE
    script += "500,1,POS_MODE,1000,500\n520,1,POS_CONTROL,1000mm/min\n"

    simulated, modelled = (run(script, "--json").json for run in (play, on_board))

    [axis, *_] = modelled["axes"]
    assert (axis["pulses"], axis["position"], axis["position_um"]) == (600, -600, 2000)
    assert axis["pulses_simulated"] == simulated["axes"][0]["pulses"] == 600
    assert (modelled["executed"], modelled["lines"]) == (8, 8)


def test_what_is_refused_is_told_as_by_the_simulator(play, on_board):
    simulated, modelled = play(REFUSED), on_board(REFUSED)

    assert (modelled.status, simulated.status) == (1, 1)
    assert modelled.err == simulated.err
    assert modelled.err.count("\n") > 10
    assert modelled.out.splitlines()[0] == simulated.out.splitlines()[0]


def test_a_fault_is_told_with_the_axis_at_the_end(on_board, tmp_path):
    inputs = tmp_path / "inputs.csv"
    inputs.write_text("# ms,input,level\n0,2,1\n100,2,0\n")

    played = on_board("0,0,SETTING,147,-2\n" + MOVE, "--inputs", inputs)

    assert (played.status, played.err) == (1, "")
    assert "FAULT, limit + active, error 7: a limit input is active" in played.out
    assert 0 < int(played.out.splitlines()[1].split()[1]) < 100


def test_the_table_tells_pulses_places_load_and_late_steps(on_board):
    played = on_board(MOVE, "--baud", "19200")

    lines = played.out.splitlines()
    assert (played.status, played.err) == (0, "")
    assert lines[1].split() == ["1", "100", "100", "100", "1.000", "REACHED"]
    assert lines[6] == "ended because the script is over and the axes stand"
    assert re.fullmatch(
        r"the script began 50 ms after power-on, at 19200 Bd; "
        r"lines went out up to [1-9]\.\d ms after their times",
        lines[7],
    )
    assert re.search(r"^load [\d.]+ %, late steps: 0$", played.out, re.MULTILINE)
    assert re.search(r"^step interrupt: [\d ]+ times, cycles \d+ at least", played.out, re.M)
    assert played.out.endswith(f"{virtual_board.MODEL}\n")


def test_a_limit_of_time_is_told_with_the_lines_that_were_not_due(on_board):
    played = on_board(MOVE + "400,1,READ\n", "--for", "0.1")

    assert (played.status, played.err) == (0, "")
    lines = played.out.splitlines()
    assert lines[1].split()[-1] == "MOVING"
    assert lines[6] == "ended at the limit of 0.1 s; --for SECONDS sets another one"
    assert lines[7] == "1 line of the script was not due"


def test_requests_keep_the_watchdog_quiet_until_they_end(on_board):
    script = "0,0,SETTING,30,150\n" + MOVE.replace("MODE,1000,", "MODE,100000,")
    script += "".join(f"{ms},1,READ\n" for ms in (140, 240))

    played = on_board(script, "--json")

    [axis, *_] = played.json["axes"]
    assert (played.status, axis["error"]) == (1, 8)
    assert 550 < axis["pulses"] < 620
    assert axis["pulses_simulated"] < 300


@pytest.mark.parametrize("option", ["--trace", "--plot"])
def test_what_the_board_cannot_tell_is_refused(play, tmp_path, option):
    played = play(MOVE, "--target", "stm32", option, tmp_path / "out.svg")

    assert played.status == 2
    assert played.complaint == (
        f"positioning: {option}: not with --target stm32; leave one of the two away"
    )


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--board", "f405"], "--board needs --target stm32"),
        (["--baud", "19200"], "--baud needs --target stm32"),
        (["--target", "stm32", "--baud", "1200"], "BD 1200 is none; did you mean 19200?"),
        (["--target", "stm32", "--board", "none"], "none: no such board"),
    ],
)
def test_what_has_no_meaning_there_is_refused(play, options, complaint):
    played = play(MOVE, *options)

    assert (played.status, played.out) == (2, "")
    assert complaint in played.err


def test_an_error_of_the_script_is_told_before_anything_is_built(play):
    played = play("0,1,POS_INIT\nX\n", "--target", "stm32", "--board", "none")

    assert played.status == 1
    assert "a.csv:2: a time, an axis and an instruction" in played.complaint


def test_bad_inputs_are_told_as_the_simulator_does(on_board, tmp_path):
    inputs = tmp_path / "inputs.csv"
    inputs.write_text("5,9,1\n")

    played = on_board(MOVE, "--inputs", inputs)

    assert played.status != 0
    assert "inputs.csv:1" in played.complaint


# ---- requests ----


def requests(text: str) -> list[bytes]:
    return [request.asked for request in requests_of(list(lines_of(text)))]


def test_a_script_is_read_as_the_simulator_reads_it():
    [line] = lines_of("# first\n\n 1.5 ,\t2 , POS_CONTROL , 1000 mm/min , 1 # and go\r\n")

    assert (line.number, line.ms, line.axis, line.values) == (3, 1.5, 2, (1000 << 16, 1))


def test_an_instruction_has_another_number_each_time():
    words = [asked[10:12] for asked in requests("0,3,POS_RESET\n" * 258)]

    assert words[:2] == [b"\x01\x03", b"\x02\x03"]
    assert words[254:257] == [b"\xff\x03", b"\x00\x03", b"\x01\x03"]


def test_feeds_of_the_same_time_are_one_request_where_their_registers_are_side_by_side():
    one = requests("5,1,POS_CONTROL,7\n5,2,POS_CONTROL,9,1\n")
    apart = ["5,2,POS_CONTROL,9,1\n6,3,POS_CONTROL,9,1", "5,2,POS_CONTROL,9,1\n5,3,POS_CONTROL,9"]

    assert one == [modbus.write_request(501, [0, 7, 1, 0, 9])]
    assert [len(requests(text)) for text in apart] == [2, 2]


class FakeTalk:
    """A line whose unit says what it is told to, a byte in each ms."""

    def __init__(self, said: bytes) -> None:
        self.ms = 50.0
        self.said = said

    def say(self, data: bytes) -> None:
        assert data

    def until(self, ms: float) -> bytes:
        byte, self.said = self.said[:1], self.said[1:]
        self.ms = self.ms + 1 if byte else ms
        return byte


@pytest.mark.parametrize(
    ("said", "deed"),
    [
        (b"", "answered"),
        (frames.sealed(bytes([23, 4, 1, 2, 0, 0])), "executed"),
        (frames.sealed(bytes([3, 2, 0, 0])), "answered as it should be"),
        (frames.sealed(bytes([0x97, 3])), "answered as it should be"),
        (frames.sealed(bytes([23, 4, 1, 1, 0, 0]))[:-1] + b"\0", "answered as it should be"),
    ],
)
def test_an_image_that_does_not_answer_as_it_should_is_told(said, deed):
    talk: Any = FakeTalk(said)
    player = Player(talk, "a.csv", list(lines_of("# take it\n0,1,POS_INIT\n")), 115_200)

    with pytest.raises(Failure) as failure:
        player.play(1.0, 0.1)

    assert str(failure.value) == (
        f"a.csv: line 2, POS_INIT, was not {deed} by the image of the board"
    )
