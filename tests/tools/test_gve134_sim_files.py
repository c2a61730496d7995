"""What `gve134 sim` writes: steps, trace, waves, curves and pictures."""

from __future__ import annotations

import json
import math
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from gve_sim import Play, player, pulses_of
from rkm04_tools.gve134 import host
from rkm04_tools.gve134.xy import path_of
from rkm04_tools.record import read_record

SQUARE = "V10000\nA100\nL2000,0\nC0,2000\nC-2000,0\nC0,-2000\n"


@pytest.fixture
def play(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Play:
    """Play a text to the simulated unit."""

    def read() -> tuple[str, str]:
        told = capsys.readouterr()
        return told.out, told.err

    return player(tmp_path, read)


def test_steps_are_those_of_motors_1_to_4(play: Play, tmp_path: Path) -> None:
    steps = tmp_path / "steps.csv"

    play("V1000\nL3,-2,0,1\nNX100\nL0,0,0,0\nNX100\nL-1\n", "--steps", steps)

    assert steps.read_text().splitlines()[:2] == ["# tick_hz=84000000", "tick,motor,position"]
    pulses = pulses_of(steps)
    assert [tick for tick, *_ in pulses] == sorted(tick for tick, *_ in pulses)
    own = {motor: [at for _, m, at in pulses if m == motor] for motor in range(1, 5)}
    assert own == {1: [1, 2, 3, 99], 2: [-1, -2], 3: [], 4: [1]}


def test_the_trace_tells_paths_stops_outputs_and_positions(play: Play, tmp_path: Path) -> None:
    trace = tmp_path / "trace.csv"

    play("O0,FB\nV1000\nL30,-20\nL0,0,0,0\nNX5\nL1000\n@1000 J\n", "--trace", trace)

    rows = [row.split(",", 1)[1] for row in trace.read_text().splitlines()[1:]]
    moves = ["1,move,0", "2,move,0", "3,move,0", "4,move,0"]
    assert rows[:10] == ["0,out,6", *moves, "1,done,30", "2,done,-20", "3,done,0", "4,done,0",
                         "1,position,5"]  # fmt: skip
    assert rows[10:14] == moves
    assert "0,stop,reset" in rows
    assert [row for row in rows[-6:] if ",position," in row] == ["1,position,0", "2,position,0"]


def test_no_pulse_comes_after_the_end_of_its_path(play: Play, tmp_path: Path) -> None:
    steps, trace = tmp_path / "steps.csv", tmp_path / "trace.csv"
    path = "V10000\nA100\nVK\nL3000,4000\nC0,2000\nC-2000,0\nC0,-2000\n"

    play(path, "--steps", steps, "--trace", trace)

    rows = [row.split(",") for row in trace.read_text().splitlines()]
    ends = [int(row[0]) for row in rows if row[2] == "done"]
    assert max(tick for tick, *_ in pulses_of(steps)) <= min(ends)


def test_waves_have_pins_leds_outputs_and_the_spindle(play: Play, tmp_path: Path) -> None:
    waves = tmp_path / "waves.vcd"

    play("EW05,FE\nV1000\nL2,0\n!7V500\n", "--vcd", waves)

    text = waves.read_text()
    codes = {
        name: code for code, name in re.findall(r"^\$var \w+ \d+ (\S) (\w+) \$end$", text, re.M)
    }
    assert {"m1_step", "m4_dir", "bi8", "bo1", "m2_position", "m3_speed"} <= codes.keys()
    assert {"led_power", "led_run", "led_data", "led_refx", "led_refa", "pwm"} <= codes.keys()
    assert "m1_led" not in codes
    assert "$scope module gve134 $end" in text
    start, _, rest = text.partition("$dumpvars\n")[2].partition("$end\n")
    assert f"1{codes['bi1']}" in start.splitlines()
    levels = re.findall(rf"^([01]){re.escape(codes['m1_step'])}$", rest, re.M)
    assert levels == ["1", "0", "1", "0", "1"]  # high at rest: the active edge falls
    assert re.search(rf"^r50(\.0+)? {re.escape(codes['pwm'])}$", rest, re.M)


def test_the_curve_of_the_program_in_c_has_all_axes_and_outputs(tmp_path: Path) -> None:
    file, curve = tmp_path / "a.gve", tmp_path / "curve.json"
    file.write_text(SQUARE + "!7V10\nO0,FF\n")
    command = [str(host.program_path()), "sim", str(file), "--curve", str(curve), "--points", "100"]
    subprocess.run(command, capture_output=True, check=True)

    told = json.loads(curve.read_bytes())

    x, y, z, a = told["motors"]
    assert (max(x["position"]), x["position"][-1], max(y["position"])) == (2000, 0, 2000)
    assert (max(x["speed"]), min(x["speed"])) == pytest.approx((10_000, -10_000))
    assert (z["position"][-1], a["position"][-1]) == (0, 0)
    assert [output[1:] for output in told["outputs"]] == [[1, 1], [5, 1], [1, 0], [5, 0]]


def test_pictures_are_drawn(play: Play, tmp_path: Path) -> None:
    xy, plot = tmp_path / "xy.svg", tmp_path / "plot.png"

    assert play(SQUARE, "--xy", xy, "--plot", plot).status == 0

    assert all(text in xy.read_text() for text in ("X (pulses)", "Y (pulses)", "start", "end"))
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.gve", "plot.png", "xy.svg"]


def test_a_file_without_motion_has_a_picture_that_says_so(play: Play, tmp_path: Path) -> None:
    xy = tmp_path / "xy.svg"
    assert play("L0,0,10\n", "--xy", xy).status == 0
    assert "nothing moved in X and Y" in xy.read_text()


def test_the_path_has_the_corners_and_the_speed_of_the_vectors(play: Play, tmp_path: Path) -> None:
    steps, trace = tmp_path / "steps.csv", tmp_path / "trace.csv"
    told = play(SQUARE.replace("L2000,0", "VK\nL3000,4000"), "--steps", steps, "--trace", trace,
                "--json").json  # fmt: skip

    path = path_of(read_record(steps, trace, None, told["seconds"], turns=True))

    assert (path.x[0], path.y[0], path.x[-1], path.y[-1]) == (0, 0, 1000, 4000)
    assert max(path.x), max(path.y) == (3000, 6000)
    assert np.nanmax(path.speed) == pytest.approx(10_000, rel=0.01)
    straight = (path.y < 3999) & (path.x < 2999)
    assert np.abs(path.y[straight] - path.x[straight] * 4 / 3).max() <= math.sqrt(2)


def test_a_path_that_begins_anew_after_a_reset_begins_at_0(play: Play, tmp_path: Path) -> None:
    steps, trace = tmp_path / "steps.csv", tmp_path / "trace.csv"
    told = play("V1000\nL100,100\n@500 J\nL50\n@1000 L50\n", "--steps", steps, "--trace", trace,
                "--json").json  # fmt: skip

    path = path_of(read_record(steps, trace, None, told["seconds"], turns=True))

    begins = np.flatnonzero(np.isnan(path.speed))
    places = [(path.x[at], path.y[at]) for at in begins]
    assert places == [(0, 0), (100, 100), (0, 0)]
