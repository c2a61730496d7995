"""The numbers and marks in pictures, waveforms and summaries are those of the pulses and events."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import re
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from picture import LEVEL, POSITION, SPEED, Picture, read_picture
from rkm04_tools.check import check_source
from rkm04_tools.cli import main
from rkm04_tools.report import Run, summary
from rkm04_tools.source import Source
from rkm04_tools.table import rounded, table, thousands

HZ = 84_000_000
PROGRAMS = {
    1: "\\ S100 V1000 A2000 F500 R T02 W100 B800 M05 R W100 =1000 W250",
    2: "W5\n  W5 O07",
    3: "S200 V400 B300 R L2 J5 E",
    4: "W1" * 705 + "F7 R =5 [",
}
"""Motor 1 is stopped by a guard, motor 3 ends with an error, the memory of motor 4 overflows."""
INPUTS = [(100.0, 3, 1), (1700.0, 5, 1), (2000.0, 5, 0)]


@dataclass(frozen=True)
class Simulated:
    """A simulation with everything that it wrote."""

    folder: Path
    table: list[list[str]]
    notes: list[str]
    answer: dict[str, Any]

    @cached_property
    def pulses(self) -> dict[int, list[tuple[int, int]]]:
        """Tick and position of each pulse, by motor."""
        found: dict[int, list[tuple[int, int]]] = {motor: [] for motor in PROGRAMS}
        for line in (self.folder / "steps.csv").read_text().splitlines()[2:]:
            tick, motor, position = map(int, line.split(","))
            found[motor].append((tick, position))
        return found

    @cached_property
    def events(self) -> list[dict[str, str]]:
        with (self.folder / "trace.csv").open(newline="") as file:
            return list(csv.DictReader(file))

    def moves(self, motor: int) -> list[tuple[int, int]]:
        """First and last tick of each move."""
        own = [e for e in self.events if e["motor"] == str(motor)]
        starts = [int(e["tick"]) for e in own if e["event"] == "move"]
        ends = [int(e["tick"]) for e in own if e["event"] == "done"]
        return list(zip(starts, ends, strict=True))

    def shortest(self, motor: int) -> int:
        """The shortest interval within moves, each of which begins with one."""
        ticks = [tick for tick, _ in self.pulses[motor]]
        found = []
        for start, end in self.moves(motor):
            own = [start, *(tick for tick in ticks if start < tick <= end)]
            found += [b - a for a, b in pairwise(own)]
        return min(found)

    @cached_property
    def picture(self) -> Picture:
        return read_picture(self.folder / "plot.svg")

    @cached_property
    def waves(self) -> dict[str, list[tuple[int, float]]]:
        """The changes of each signal of the waveforms: nanoseconds and value."""
        head, _, body = (self.folder / "waves.vcd").read_text().partition("$enddefinitions $end")
        names = dict(re.findall(r"\$var \w+ \d+ (\S+) (\w+) \$end", head))
        found: dict[str, list[tuple[int, float]]] = {name: [] for name in names.values()}
        now = 0
        for line in body.split("\n"):
            if line.startswith("#"):
                now = int(line[1:])
            elif match := re.fullmatch(r"(?:([01])|r(\S+) )(\S)", line):
                found[names[match[3]]].append((now, float(match[1] or match[2])))
        found["end"] = [(now, 0.0)]
        return found


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Simulated:
    folder = tmp_path_factory.mktemp("shown")
    arguments = ["sim", "--for", "3"]
    for motor, text in PROGRAMS.items():
        path = folder / f"{motor}.rks"
        path.write_text(text)
        arguments += ["--motor", f"{motor}={path}"]
    inputs = folder / "in.csv"
    inputs.write_text("".join(f"{ms},{number},{level}\n" for ms, number, level in INPUTS))
    arguments += ["--inputs", str(inputs)]
    for name in ("steps.csv", "trace.csv", "waves.vcd", "plot.svg"):
        arguments += [f"--{name.partition('.')[0].replace('waves', 'vcd')}", str(folder / name)]
    out, told = io.StringIO(), io.StringIO()
    with contextlib.redirect_stderr(io.StringIO()):
        with contextlib.redirect_stdout(out):
            assert main(arguments) == 1
        with contextlib.redirect_stdout(told):
            assert main([*arguments, "--json"]) == 1
    lines = out.getvalue().splitlines()
    rows = [re.split(r"  +", line.strip()) for line in lines[:5]]
    return Simulated(folder, rows, lines[6:], json.loads(told.getvalue()))


@pytest.mark.parametrize("motor", PROGRAMS)
def test_each_column_of_a_summary_is_that_of_its_motor(simulated, motor):
    pulses, moves = simulated.pulses[motor], simulated.moves(motor)
    own = dict(zip(simulated.table[0], simulated.table[motor], strict=True))
    writes = {1: 1000, 4: 5}
    position = writes.get(motor) or (pulses[-1][1] if pulses else 0)

    assert own["motor"] == str(motor)
    assert own["program"] == str(simulated.folder / f"{motor}.rks")
    assert own["moves"] == str(len(moves))
    assert own["pulses"] == thousands(len(pulses))
    assert own["position"] == thousands(position)
    peak = HZ / simulated.shortest(motor) if moves else 0
    assert float(own["peak steps/s"]) == pytest.approx(peak, abs=0.051)
    moving = sum(end - start for start, end in moves) / HZ
    assert float(own["moving s"]) == pytest.approx(moving, abs=0.00051)
    states = {1: "done", 2: "at O07, line 2", 3: "error", 4: "held, waits for ]"}
    assert own["at the end"] == states[motor]


def test_json_has_the_same_columns(simulated):
    for told in simulated.answer["motors"]:
        own = dict(zip(simulated.table[0], simulated.table[told["motor"]], strict=True))
        assert thousands(told["pulses"]) == own["pulses"]
        assert thousands(told["position"]) == own["position"]
        assert f"{told['seconds_moving']:.3f}" == own["moving s"]
        assert f"{told['peak_speed']:.1f}" == own["peak steps/s"]
        assert told["overflow"] == (told["motor"] == 4)


def test_the_notes_name_the_motor_and_the_outputs(simulated):
    assert simulated.notes[2:] == ["motor 4: program memory was full", "outputs that are on: 2"]
    assert simulated.answer["outputs"] == 0b10


def test_variables_are_told_apart_from_outputs(tool, write):
    answer = tool("sim", write("T83 T90 T04"), "--json").json

    assert (answer["variables"], answer["outputs"]) == (1 << 3 | 1 << 10, 1 << 3)


def run_of(told: dict[str, Any]) -> Run:
    numbers = {"motor": 2, "moves": 1, "pulses": 2, "position": -3, "place": 0}
    usual = {"peak_speed": 4.0, "seconds_moving": 5.0, "state": "idle", "error": ""}
    return Run(
        {**numbers, **usual, "overflow": False, **told}, check_source(Source("a.rks", "F1 R"))
    )


@pytest.mark.parametrize(("late", "note"), [(1, ["1 pulses came too late"]), (0, [])])
def test_late_pulses_are_told(late, note):
    answer = {"seconds": 1.0, "real_seconds": 0.5, "ratio": 2.0, "ended": "idle", "outputs": 0}

    text = summary({**answer, "late_steps": late}, [run_of({})], "60")

    assert text.splitlines()[5:] == note


@pytest.mark.parametrize("motor", [1, 3, 4])
def test_the_axes_of_a_picture_say_what_the_curves_are(simulated, motor):
    picture, pulses = simulated.picture, simulated.pulses[motor]
    speeds = picture.panel(f"motor {motor}", "speed", "(steps/s)")
    positions = picture.panel(f"motor {motor}", "position", "(steps)")
    speed = picture.curve(speeds, SPEED)
    position = picture.curve(positions, POSITION)

    peak = HZ / simulated.shortest(motor)
    assert max(abs(y) for _, y in speed) == pytest.approx(peak, rel=0.002)
    backward = any(b < a for (_, a), (_, b) in pairwise(pulses))
    assert (min(y for _, y in speed) < -1) == backward
    ticks = [tick for tick, _ in pulses]
    for seconds in (0.2, 0.7, 1.3, 1.9, 2.4):
        index = bisect_right(ticks, round(seconds * HZ))
        true = pulses[index - 1][1] if index else pulses[0][1] - (1 if pulses[0][1] > 0 else -1)
        assert height_at(position, seconds) == pytest.approx(true, abs=6), seconds
    assert position[-1][0] == pytest.approx(simulated.answer["seconds"], abs=0.003)
    assert positions.left < max(x for x, _ in positions.lines[0].points) < positions.right


def height_at(curve: list[tuple[float, float]], seconds: float) -> float:
    """Where a line stands at a time."""
    for (a, low), (b, high) in pairwise(curve):
        if a <= seconds <= b:
            return low if b == a else low + (high - low) * (seconds - a) / (b - a)
    raise AssertionError(f"the line does not reach {seconds} s")


def test_stops_are_marked_at_their_time_and_with_their_cause_in_their_panel(simulated):
    picture = simulated.picture
    marks = {
        (event["motor"], f"{event['event']}: {event['value']}".replace("stop:", "stop")):
            int(event["tick"]) / HZ
        for event in simulated.events if event["event"] in ("stop", "error")
    }  # fmt: skip
    assert set(marks) == {("1", "stop M"), ("3", "error: label not found")}
    found = {}
    for panel in picture.panels:
        dotted = [line for line in panel.lines if line.is_dotted]
        assert len(dotted) == len(panel.notes)
        for line, (note, _) in zip(dotted, panel.notes, strict=True):
            found[panel.label[0][-1], note] = picture.seconds(line.points[0][0])
    assert found == pytest.approx(marks, abs=0.003)


def test_each_signal_has_its_own_row_with_its_levels(simulated):
    panel = simulated.picture.panels[-1]
    rows = dict(panel.y_ticks)
    changes: dict[str, list[tuple[float, int]]] = {"BI 3": [], "BI 5": [], "BI 7": [], "BO 2": []}
    for ms, number, level in INPUTS:
        changes[f"BI {number}"].append((ms / 1000, level))
    (on,) = [e for e in simulated.events if e["event"] == "out"]
    changes["BO 2"].append((int(on["tick"]) / HZ, 1))

    assert set(rows) == set(changes)
    for name, at in rows.items():
        (line,) = [
            each for each in panel.lines
            if each.colour == LEVEL and abs(at - max(y for _, y in each.points)) < 12
            and max(y for _, y in each.points) > at > max(y for _, y in each.points) - 12
        ]  # fmt: skip
        points = line.points
        found = [
            (simulated.picture.seconds(x), int(b < a))
            for (_, a), (x, b) in pairwise(points) if a != b
        ]  # fmt: skip
        assert [level for _, level in found] == [level for _, level in changes[name]], name
        assert [t for t, _ in found] == pytest.approx([t for t, _ in changes[name]], abs=0.003)


def test_waveforms_last_to_the_end_of_the_simulation(simulated):
    (end, _), *_ = simulated.waves["end"]

    assert end == pytest.approx(simulated.answer["seconds"] * 1e9, abs=1)
    assert end > max(at for name, own in simulated.waves.items() if name != "end" for at, _ in own)


@pytest.mark.parametrize("motor", PROGRAMS)
def test_waveforms_have_speed_and_position_of_each_pulse(simulated, motor):
    pulses, moves = simulated.pulses[motor], simulated.moves(motor)
    speeds = simulated.waves[f"m{motor}_speed"]
    positions = simulated.waves[f"m{motor}_position"]

    wanted, before = [], 0
    starts = [start for start, _ in moves]
    for tick, _ in pulses:
        start = starts[bisect_right(starts, tick - 1) - 1]
        wanted.append((ns(tick), round(HZ / (tick - max(before, start)), 3)))
        before = tick
    for at, speed in wanted:
        shown = [each for t, each in speeds if t == at][:1] or [speed_at(speeds, at)]
        assert shown == pytest.approx([speed], abs=0.0011), at
    for _, end in moves:
        assert speed_at(speeds, ns(end) + 1000) == 0
    assert speeds[-1][1] == 0
    at_pulses = dict(positions)
    assert all(at_pulses[ns(tick)] == position for tick, position in pulses)
    assert positions[-1][1] == simulated.answer["motors"][motor - 1]["position"]


def ns(tick: int) -> int:
    return (tick * 10**9 + HZ // 2) // HZ


def speed_at(changes: list[tuple[int, float]], at: int) -> float:
    return changes[bisect_right(changes, (at, float("inf"))) - 1][1]


@pytest.mark.parametrize("motor", PROGRAMS)
def test_every_step_of_the_waveforms_rises_at_its_pulse_and_falls(simulated, motor):
    steps = simulated.waves[f"m{motor}_step"][1:]

    assert [level for _, level in steps] == [1, 0] * len(simulated.pulses[motor])
    assert [at for at, _ in steps[::2]] == [ns(tick) for tick, _ in simulated.pulses[motor]]
    assert all(
        0 < low - high < 100_000
        for (high, _), (low, _) in zip(steps[::2], steps[1::2], strict=True)
    )


def test_inputs_and_outputs_of_the_waveforms_are_apart(simulated):
    (on,) = [int(e["tick"]) for e in simulated.events if e["event"] == "out"]

    assert simulated.waves["bo2"] == [(0, 0), (ns(on), 1)]
    assert simulated.waves["bi5"][1:] == [(1_700_000_000, 1), (2_000_000_000, 0)]
    assert simulated.waves["bi3"][1:] == [(100_000_000, 1)]
    for name in ("bi1", "bi2", "bo1", "bo3", "bo5"):
        assert simulated.waves[name] == [(0, 0)]


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (0, "0"),
        (99.94, "99.9"),
        (100, "100"),
        (432.1, "432"),
        (12_345.6, "12 346"),
        (-1500, "-1 500"),
        (0.012345, "0.0123"),
    ],
)
def test_figures_are_rounded_to_what_can_be_read(number, text):
    assert rounded(number) == text


def test_a_table_has_its_columns_in_line():
    assert table([("n", "name"), ("10", "b"), ("5", "long")], "rl") == (" n  name\n10  b\n 5  long")
