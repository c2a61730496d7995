"""The plot: its lines are those of the pulses, and the picture shows what happened."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
from rkm04_tools.curve import COLUMNS, position_line, speed_line, thinned
from rkm04_tools.host import Command
from rkm04_tools.record import Event, Move, Pulses, Record
from rkm04_tools.signals import Signal, signals

EXAMPLES = Path(__file__).resolve().parents[2] / "tools" / "examples"


def pulses(ticks: list[int], positions: list[int]) -> Pulses:
    return Pulses(np.array(ticks, dtype=np.int64), np.array(positions, dtype=np.int64))


def texts(path: Path) -> list[str]:
    """All texts of an SVG picture; the library keeps them as comments beside their outlines."""
    return re.findall(r"<!-- (.*?) -->", path.read_text())


def test_the_speed_is_that_of_each_interval_in_its_middle_and_0_outside_moves():
    own = pulses([200, 300, 500], [1, 2, 1])
    moves = [Move(100, 300, 1, done=True), Move(400, 500, -1, done=True)]

    time, speed = speed_line(own, moves, hz=1000)

    assert time.tolist() == [0.1, 0.1, 0.15, 0.25, 0.3, 0.3, 0.4, 0.4, 0.45, 0.5, 0.5]
    assert speed.tolist() == [0, 10, 10, 10, 10, 0, 0, -10, -10, -10, 0]


def test_a_move_without_pulses_has_no_speed():
    moves = [Move(0, 0, 1, done=True), Move(100, 300, 1, done=True)]

    time, speed = speed_line(pulses([300], [1]), moves, hz=1000)

    assert (time.tolist(), speed.tolist()) == ([0.1, 0.1, 0.2, 0.3, 0.3], [0, 5, 5, 5, 0])


def test_a_move_that_is_not_done_keeps_its_speed():
    _, speed = speed_line(pulses([100], [1]), [Move(0, 150, 1, done=False)], hz=1000)

    assert speed.tolist() == [0, 10, 10, 10, 10]


@pytest.mark.parametrize(
    ("start", "end", "at_last"), [(100, 255, -100), (0, 255, -100), (100, 600, 0)]
)
def test_an_axis_that_rests_in_a_path_has_no_speed(start: int, end: int, at_last: int) -> None:
    own = pulses([110, 120, 130, 230, 240, 250], [1, 2, 3, 2, 1, 0])
    signs = np.array([1, 1, 1, -1, -1, -1])

    time, speed = speed_line(own, [Move(start, end, 1, done=True)], hz=1000, signs=signs)

    def at(ms: float) -> float:
        return float(np.interp(ms / 1000, time, speed))

    assert np.all(np.diff(time) >= 0)
    assert [at(50), at(118), at(131), at(180), at(229), at(242)] == [0, 100, 0, 0, 0, -100]
    assert at(end - 1) == at_last


def test_a_ramp_from_standstill_is_no_rest() -> None:
    ticks = [round(1000 * np.sqrt(k)) for k in range(1, 200)]
    own = pulses(ticks, list(range(1, 200)))

    _, speed = speed_line(own, [Move(0, ticks[-1], 1, done=True)], 1000, np.ones(199, np.int64))

    assert np.all(speed[1:-1] > 0)


def test_the_position_starts_before_the_first_pulse_and_lasts_to_the_end():
    time, position = position_line(pulses([100, 200], [-1, 0]), 0, end=0.5, hz=1000)

    assert (time.tolist(), position.tolist()) == ([0, 0.1, 0.2, 0.5], [0, -1, 0, 0])


def test_a_short_line_keeps_all_its_points():
    time = np.linspace(0, 1, 4 * COLUMNS)

    assert len(thinned(time, time, 1.0)[0]) == 4 * COLUMNS


def test_a_long_line_keeps_its_ends_and_extremes_in_order():
    time = np.linspace(0, 1, 100_000)
    value = np.sin(50 * time)
    value[33_333], value[66_666] = 7.0, -7.0

    thin_time, thin_value = thinned(time, value, 1.0)

    assert len(thin_time) <= 4 * (COLUMNS + 1)
    assert np.all(np.diff(thin_time) >= 0)
    assert (thin_value.max(), thin_value.min()) == (7.0, -7.0)
    assert (thin_value[0], thin_value[-1]) == (value[0], value[-1])


@pytest.mark.parametrize("sign", [1, -1])
def test_a_long_ramp_stays_a_ramp(sign):
    time = np.linspace(0, 1, 100_000)

    _, value = thinned(time, sign * time, 1.0)

    assert np.all(sign * np.diff(value) >= 0)


def test_a_signal_holds_its_level_until_the_next_change():
    signal = Signal("BI 1", [(1.0, 1), (2.0, 0), (9.0, 1)])

    assert signal.corners(5.0) == ([0.0, 1.0, 2.0, 5.0], [0, 1, 0, 0])


def test_signals_are_those_that_changed_or_are_named():
    commands = [
        Command(0, "JUMP_IF_HIGH", 3, 1, "I03H01"),
        Command(0, "JUMP_IF_LOW", 81, 1, "I81L01"),
        Command(0, "FUNCTION_ON", 0, 55, "T55"),
        Command(0, "WAIT_INPUT_LOW", 0, 8, "Z08"),
        Command(0, "WAIT_VARIABLE_LOW", 0, 82, "Z82"),
        Command(0, "SPEED", 0, 7, "V7"),
        Command(0, "FUNCTION_ON", 0, 41, "T41"),
    ]
    events = [Event(10, 0, "out", "2"), Event(20, 0, "out", "-2"), Event(30, 0, "var", "80")]
    record = Record(1000, 100, {}, events, [(50.0, 4, 1)])

    found = {signal.name: signal.changes for signal in signals(record, commands)}

    assert list(found) == [
        "BI 3", "BI 4", "BI 8", "BO 2", "BO 5", "var 80", "var 81", "var 82",
    ]  # fmt: skip
    assert found["BO 2"] == [(0.01, 1), (0.02, 0)]
    assert found["BI 4"] == [(0.05, 1)]


def test_an_svg_picture_has_panels_with_units_and_the_signals(tool, tmp_path):
    out = tmp_path / "plot.svg"

    result = tool("sim", EXAMPLES / "6-guards.rks", "--inputs", EXAMPLES / "6-guards.csv",
                  "--plot", out)  # fmt: skip

    assert (result.status, result.err) == (0, "")
    root = ElementTree.parse(out).getroot()
    assert root.tag.endswith("svg")
    assert (root.get("width"), root.get("height")) == ("841.68pt", "595.44pt")
    shown = texts(out)
    for text in ["6-guards.rks", "time (s)", "BI 3", "BI 6", "stop M", "stop N", "motor 1"]:
        assert text in shown
    assert shown.count("(steps/s)") == shown.count("(steps)") == 1
    assert "BI 1" not in shown


def test_no_text_of_a_picture_is_smaller_than_8_points(tool, tmp_path):
    out = tmp_path / "plot.svg"

    assert tool("sim", EXAMPLES / "8-subroutine.rks", "--plot", out, "--for", "5").status == 0

    # The outlines of letters are drawn at 100 units to the size of the font.
    scales = [float(s) for s in re.findall(r"scale\(([\d.]+) -[\d.]+\)", out.read_text())]
    assert scales
    assert min(scales) * 100 >= 8


def test_a_png_picture_is_as_large_as_a_page_and_not_empty(tool, tmp_path):
    from matplotlib.image import imread

    out = tmp_path / "plot.PNG"

    assert tool("sim", EXAMPLES / "9-compound.rks", "--plot", out).status == 0

    image = imread(out)
    assert image.shape[:2] == (1240, 1753)
    assert 0.005 < np.mean(image[:, :, :3] < 0.5) < 0.2


def test_each_motor_that_moved_has_its_panels(tool, write, tmp_path):
    out = tmp_path / "plot.svg"
    moving, still = write("F10 R"), write("W1", "b.rks")

    assert tool("sim", moving, "--motor", f"2={still}", "--motor", f"4={moving}",
                "--plot", out).status == 0  # fmt: skip

    shown = texts(out)
    assert ("motor 1" in shown, "motor 2" in shown, "motor 4" in shown) == (True, False, True)
    assert "motor 1: a.rks, motor 2: b.rks, motor 4: a.rks" in shown


def test_a_run_without_any_move_says_so(tool, write, tmp_path):
    out = tmp_path / "plot.svg"

    assert tool("sim", write("W1"), "--plot", out).status == 0

    assert "a.rks (no motor moved)" in texts(out)


@pytest.mark.parametrize("program", ["", "F1 R", "B1 R", "G+", "T41 F10 R", "=500 F1 R C100 B1 R"])
def test_any_run_can_be_drawn(tool, write, tmp_path, program):
    out = tmp_path / "plot.png"

    result = tool("sim", write(program), "--plot", out, "--for", "0.05")

    assert result.status == 0
    assert out.stat().st_size > 1000


def test_a_name_is_shown_as_it_is(tool, write, tmp_path):
    out = tmp_path / "plot.svg"

    assert tool("sim", write("F1 R", "$x^2$ 漢.rks"), "--plot", out).status == 0

    assert "$x^2$ 漢.rks" in texts(out)


def test_a_page_grows_when_there_is_too_much_for_it(tool, write, tmp_path):
    out = tmp_path / "plot.svg"
    every = " ".join(f"T{n} T{n + 79} I{n}H1" for n in range(1, 9)) + " @1 F5 R"
    program = write(every)

    motors = [f"--motor={motor}={program}" for motor in range(1, 5)]
    assert tool("sim", *motors, "--plot", out).status == 0

    assert float(ElementTree.parse(out).getroot().get("height", "0pt")[:-2]) > 596
