"""The vectors of G-code against positions that are computed another way, in fractions."""

from __future__ import annotations

import itertools
import math
import random
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

import pytest
from chance import SEED
from gcode_played import Played, content, good, mill
from hypothesis import given, settings
from hypothesis import strategies as st
from rkm04_tools.gve134.gcode.axes import Mill

LETTERS = "XYZA"
INCH = Fraction(254, 10)
HALF = Fraction(1, 2)


@dataclass
class Reference:
    """Positions of a program of lines, in exact mm and degrees."""

    inch: bool = False
    absolute: bool = True

    def __post_init__(self) -> None:
        self.at = [Fraction(0)] * 4
        self.offset = [Fraction(0)] * 4

    def take(self, line: str) -> None:
        """Follow a line of words with blanks between."""
        words = line.split()
        self.inch = {"G20": True, "G21": False}.get(words[0], self.inch)
        self.absolute = {"G90": True, "G91": False}.get(words[0], self.absolute)
        for word in words[1:] if words[0][0] == "G" else words:
            index = LETTERS.find(word[0])
            if index < 0:
                continue
            value = Fraction(word[1:]) * (INCH if self.inch and index < 3 else 1)
            if words[0] == "G92":
                self.offset[index] = self.at[index] - value
            elif self.absolute:
                self.at[index] = self.offset[index] + value
            else:
                self.at[index] += value


numbers = st.decimals(-300, 300, places=4).map(lambda value: f"{value:f}")
places = st.lists(st.tuples(st.sampled_from(LETTERS), numbers), min_size=1, max_size=4,
                  unique_by=lambda pair: pair[0])  # fmt: skip
motions = st.builds(
    lambda code, words: " ".join([code, *(letter + number for letter, number in words)]),
    st.sampled_from(["G0", "G1", "G92"]),
    places,
)
blocks = st.lists(motions | st.sampled_from(["G20", "G21", "G90", "G91"]), max_size=30)
metric_blocks = st.lists(motions | st.sampled_from(["G90", "G91"]), max_size=30)


def scales(machine: Mill) -> list[Fraction]:
    """Pulses of a mm or degree."""
    return [axis.steps_per_unit for axis in machine.axes if axis]


@given(blocks)
@settings(max_examples=150, deadline=None)
def test_each_line_ends_within_half_a_pulse_of_where_it_should(lines: list[str]) -> None:
    machine, reference = mill(), Reference()
    program = ["G1 F100", *(f"{line} F100" if line[:2] == "G1" else line for line in lines)]

    ends = good(program, machine).ends()

    last = (0, 0, 0, 0)
    for number, line in enumerate(program, 1):
        reference.take(line)
        last = ends.get(number, last)
        for steps, exact, scale in zip(last, reference.at, scales(machine), strict=True):
            assert abs(steps - exact * scale) <= HALF


@pytest.mark.parametrize(("units", "moves"), [("G21", 100_000), ("G20", 20_000)])
def test_many_small_moves_do_not_drift(units: str, moves: int) -> None:
    chance = random.Random(SEED)
    total = [0] * 4
    program = [f"{units} G91 G1 F50"]
    for _ in range(moves):
        ways = [chance.randrange(-9, 10) for _ in LETTERS]
        total = [a + b for a, b in zip(total, ways, strict=True)]
        words = (f"{LETTERS[i]}{Decimal(way) / 10_000:f}" for i, way in enumerate(ways))
        program.append(" ".join(words))
    machine = mill()

    ends = good(program, machine).vectors

    sums = [sum(vector.steps[index] for vector in ends) for index in range(4)]
    for index, scale in enumerate(scales(machine)):
        factor = INCH if units == "G20" and index < 3 else 1
        exact = Fraction(total[index], 10_000) * factor * scale
        assert abs(sums[index] - exact) <= HALF


PLANES = {"G17": (0, 1, "IJ"), "G18": (2, 0, "KI"), "G19": (1, 2, "JK")}


@dataclass(frozen=True)
class Arc:
    """An arc in a plane: centre from its start, end from its start, in whole µm, and the turn."""

    plane: str
    clockwise: bool
    centre: tuple[int, int]
    end: tuple[int, int]
    across: int
    radius: float
    turn: float

    @property
    def words(self) -> str:
        """As I, J, K tell it, from the present position on."""
        one, two, centres = PLANES[self.plane]
        across = 3 - one - two
        return (
            f"G91 {self.plane} {'G2' if self.clockwise else 'G3'} "
            f"{LETTERS[one]}{mm(self.end[0])} {LETTERS[two]}{mm(self.end[1])} "
            f"{LETTERS[across]}{mm(self.across)} "
            f"{centres[0]}{mm(self.centre[0])} {centres[1]}{mm(self.centre[1])}"
        )


def mm(micrometres: int) -> str:
    """A whole number of µm in mm."""
    return f"{Decimal(micrometres) / 1000:f}"


@st.composite
def arcs(draw: st.DrawFn) -> Arc:
    """An arc whose points are whole µm, as CAM programs write them."""
    radius = draw(st.integers(200, 40_000))
    begin = draw(st.floats(0, 2 * math.pi))
    turn = draw(st.floats(0.05, 2 * math.pi - 0.05))
    clockwise = draw(st.booleans())
    centre = (-round(radius * math.cos(begin)), -round(radius * math.sin(begin)))
    over = begin + (-turn if clockwise else turn)
    end = (centre[0] + round(radius * math.cos(over)), centre[1] + round(radius * math.sin(over)))
    exact = math.hypot(*centre)
    return Arc(draw(st.sampled_from(sorted(PLANES))), clockwise, centre, end,
               draw(st.integers(-2000, 2000)), exact / 1000, turn)  # fmt: skip


def corners(played: Played, machine: Mill, arc: Arc) -> list[tuple[float, float]]:
    """The corners of the chords in the plane of an arc, in mm from its centre."""
    one, two, _ = PLANES[arc.plane]
    scale = [float(each) for each in scales(machine)]
    at = [0, 0, 0, 0]
    found = []
    for vector in [None, *played.vectors]:
        if vector is not None:
            at = [a + b for a, b in zip(at, vector.steps, strict=True)]
        found.append((at[one] / scale[one] - arc.centre[0] / 1000,
                      at[two] / scale[two] - arc.centre[1] / 1000))  # fmt: skip
    return found


ROUNDING_MM = 0.003
"""Half a pulse on each of two axes, and a µm of the program's own rounding."""


@given(arcs(), st.sampled_from([0.002, 0.01, 0.1]))
@settings(max_examples=150, deadline=None)
def test_chords_stay_within_the_tolerance_of_their_arc(arc: Arc, tolerance: float) -> None:
    machine = mill()
    played = good(["F300", arc.words], machine, tolerance=tolerance)

    points = corners(played, machine, arc)
    turned = 0.0
    for (x0, y0), (x1, y1) in itertools.pairwise(points):
        for x, y in ((x1, y1), ((x0 + x1) / 2, (y0 + y1) / 2)):
            assert abs(math.hypot(x, y) - arc.radius) <= tolerance + ROUNDING_MM
        turned += math.atan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1)
    slack = 2 * ROUNDING_MM / arc.radius
    assert turned == pytest.approx(-arc.turn if arc.clockwise else arc.turn, abs=slack)


@given(arcs())
@settings(max_examples=100, deadline=None)
def test_an_arc_ends_where_the_program_says(arc: Arc) -> None:
    machine = mill()
    (end,) = good(["F300", arc.words], machine).ends().values()

    one, two, _ = PLANES[arc.plane]
    wanted = [Fraction(0)] * 4
    wanted[one], wanted[two] = Fraction(arc.end[0], 1000), Fraction(arc.end[1], 1000)
    wanted[3 - one - two] = Fraction(arc.across, 1000)
    for steps, exact, scale in zip(end, wanted, scales(machine), strict=True):
        assert abs(steps - exact * scale) <= HALF


@given(arcs(), st.booleans())
@settings(max_examples=100, deadline=None)
def test_a_radius_is_the_shorter_way_round_and_a_negative_one_the_longer(
    arc: Arc, is_longer: bool
) -> None:
    turn = 2 * math.pi - arc.turn if (arc.turn < math.pi) == is_longer else arc.turn
    clockwise = arc.clockwise == (turn == arc.turn)
    one, two, _ = PLANES[arc.plane]
    machine, sign = mill(), "-" if is_longer else ""

    played = good(
        f"F300\nG91 {arc.plane} {'G2' if clockwise else 'G3'} {LETTERS[one]}{mm(arc.end[0])} "
        f"{LETTERS[two]}{mm(arc.end[1])} R{sign}{arc.radius:.6f}",
        machine,
    )

    length = sum(
        math.hypot(
            vector.steps[one] / scales(machine)[one], vector.steps[two] / scales(machine)[two]
        )
        for vector in played.vectors
    )
    # Near half a turn the centre depends on the last digit of the end.
    if abs(turn - math.pi) > 0.2:
        assert length == pytest.approx(arc.radius * turn, rel=0.02, abs=0.02)


@pytest.mark.parametrize("plane", sorted(PLANES))
@pytest.mark.parametrize("word", ["G2", "G3"])
def test_an_arc_without_an_end_is_a_whole_turn(plane: str, word: str) -> None:
    machine = mill()
    letters = PLANES[plane][2]
    played = good(f"F300\n{plane} {word} {letters[0]}5", machine)

    points = corners(played, machine, Arc(plane, word == "G2", (5000, 0), (0, 0), 0, 5.0, 0))
    assert points[0] == pytest.approx(points[-1])
    quarter = points[len(points) // 4]
    assert quarter[1] == pytest.approx(5.0 if word == "G2" else -5.0, abs=0.1)
    assert len({vector.line for vector in played.vectors}) == 1


@given(metric_blocks, st.sampled_from([30, 100, 240]))
@settings(max_examples=80, deadline=None)
def test_the_feed_is_that_of_x_y_and_z_together(lines: list[str], feed: int) -> None:
    machine = mill()
    scale = [float(each) for each in scales(machine)]

    played = good([f"F{feed}", *(line.replace("G0", "G1") for line in lines)], machine)

    for vector in played.vectors:
        way = math.sqrt(sum((s / k) ** 2 for s, k in zip(vector.steps[:3], scale, strict=False)))
        if way == 0:
            way = abs(vector.steps[3]) / scale[3]
        wanted = 60 * way / feed
        assert vector.seconds == pytest.approx(wanted, rel=0.51 / vector.speed)


@given(metric_blocks)
@settings(max_examples=80, deadline=None)
def test_no_axis_accelerates_faster_than_it_may(lines: list[str]) -> None:
    told = content()
    told["gve134"]["axes"]["z"]["accel_steps_per_s2"] = 33_000
    machine = mill(told)
    for vector in good(["G1 F100", *lines], machine).vectors:
        length = max(map(abs, vector.steps))
        for steps, axis in zip(vector.steps, machine.axes, strict=True):
            assert axis is not None
            assert vector.accel * 1000 * abs(steps) <= axis.accel * length * (1 + 1e-9)


def test_a_block_of_g93_takes_its_time() -> None:
    played = good("G93\nG1 X10 Y5 Z-3 F2\nG2 X20 I5 F4\nG1 A90 F3")
    seconds = dict.fromkeys((2, 3, 4), 0.0)
    for vector in played.vectors:
        seconds[vector.line] += vector.seconds
    assert seconds == {line: pytest.approx(want, rel=0.002)
                       for line, want in ((2, 30), (3, 15), (4, 20))}  # fmt: skip


def test_arcs_are_slow_enough_for_the_acceleration() -> None:
    played = good("F2400\nG3 X0.2 I0.1", tolerance=0.0001)

    limit = math.sqrt(500 * 0.1) * 320
    assert max(vector.speed for vector in played.vectors) <= round(limit)
    ((line, message),) = played.warnings
    assert line == 2
    assert "of arcs go slower than F" in message
