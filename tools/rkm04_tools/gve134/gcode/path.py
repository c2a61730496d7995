"""Where the program is, and how lines and arcs of it become vectors.

Positions are whole parts of a mm (see `axes`), those in pulses are rounded from them, never summed.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from math import hypot, sqrt

from rkm04_tools.gve134.gcode.arcs import Arc
from rkm04_tools.gve134.gcode.axes import AXES, LETTERS, PARTS, Axis, Mill
from rkm04_tools.gve134.gcode.writer import Steps, Writer

FEED, RAPID, ARC, PROBE = "feed", "rapid", "arc", "probe"
KINDS = (RAPID, FEED, ARC, PROBE)


class OutOfReach(Exception):
    """A position to which there is no way."""


@dataclass(slots=True)
class Pace:
    """How fast it goes. `seconds`, of G93, are for the whole motion; 0: the feed counts."""

    feed: float = 0.0
    """mm/s; 0 with a `seconds` of 0: as fast as the axes go."""
    turn: float = 0.0
    """degree/s, where A alone moves."""
    seconds: float = 0.0
    cap: float = 0.0
    """mm/s; 0: none."""


@dataclass(slots=True)
class Path:
    """The place of all axes, and the vectors that lead there."""

    mill: Mill
    writer: Writer
    tolerance: float
    parts: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    steps: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    offset: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    """What G92 has set: a position less what the program calls it."""
    unknown: set[int] = field(default_factory=set)
    """Axes of which nobody knows the position until they have been probed."""
    homed: set[int] = field(default_factory=set)
    lengths: dict[str, float] = field(default_factory=lambda: dict.fromkeys(KINDS, 0.0))
    """mm, by kind; of moves of A alone, degrees."""
    turned: float = 0.0
    slowed_arcs: int = 0
    without_pulse: int = 0
    """Moves that are shorter than a pulse."""
    _scales: list[tuple[int, int, int]] = field(init=False)
    """Pulses of a part, as a fraction, and half of its denominator, which is even."""
    _per_unit: list[float] = field(init=False)
    _is_even: bool = field(init=False)
    """X, Y and Z have pulses of one length."""

    def __post_init__(self) -> None:
        per_unit = [axis.steps_per_unit if axis else Fraction(1) for axis in self.mill.axes]
        scales = [each / PARTS for each in per_unit]
        self._scales = [
            (2 * scale.numerator, 2 * scale.denominator, scale.denominator) for scale in scales
        ]
        self._per_unit = [float(each) for each in per_unit]
        self._is_even = len(set(per_unit[:3])) == 1
        self.steps = [self._rounded(index) for index in AXES]

    def line_to(self, target: list[int], pace: Pace, kind: str) -> None:
        """Go straight to a position."""
        before = self.parts
        steps = self._go(target)
        if any(steps):
            rate, extent = self._rate(steps, pace, kind)
            self.writer.join(steps, extent, rate, kind is RAPID)
        elif target != before:
            self.without_pulse += 1

    def probe_to(self, target: list[int], pace: Pace) -> None:
        """Go straight to a position, where the sensor may end the way."""
        moved = [index for index in AXES if target[index] != self.parts[index]]
        steps = self._go(target)
        if not any(steps):
            raise OutOfReach("G38.2: the way is shorter than a pulse")
        rate, extent = self._rate(steps, pace, PROBE)
        self.writer.probe(steps, extent, rate)
        self.unknown.update(moved)
        self.homed.difference_update(moved)

    def arc_to(self, target: list[int], arc: Arc, centre: tuple[int, int], plane: tuple[int, int],
               pace: Pace) -> None:  # fmt: skip
        """Go along an arc, and straight along with it on the axes outside its plane."""
        chords = arc.chords(self.tolerance)
        pace = Pace(pace.feed, pace.turn, pace.seconds / chords, self._bend(arc, plane))
        begin, (one, two) = list(self.parts), plane
        others = [i for i in AXES if i not in plane and target[i] != begin[i]]
        for i, (u, v) in enumerate(arc.corners(chords), 1):
            corner = list(begin)
            corner[one] = centre[0] + round(u * PARTS)
            corner[two] = centre[1] + round(v * PARTS)
            for other in others:
                corner[other] += (target[other] - begin[other]) * i // chords
            self.line_to(corner, pace, ARC)
        self.line_to(target, pace, ARC)

    def home(self, axis: Axis) -> None:
        """Make a reference run; then the axis is where the machine file says, without G92."""
        assert axis.homing is not None
        self.writer.home(axis, axis.homing)
        index, steps = axis.index, axis.homing.position_steps
        self.parts[index] = axis.parts_of(steps)
        self.steps[index] = steps
        self.offset[index] = 0
        self.unknown.discard(index)
        self.homed.add(index)

    def _rounded(self, index: int) -> int:
        numerator, denominator, half = self._scales[index]
        return (numerator * self.parts[index] + half) // denominator

    def _go(self, target: list[int]) -> Steps:
        """Take a position; the pulses that lead there."""
        if self.homed:
            self._require_reach(target)
        (n0, d0, h0), (n1, d1, h1), (n2, d2, h2), (n3, d3, h3) = self._scales
        x0, y0, z0, a0 = self.steps
        now, (to_x, to_y, to_z, to_a) = self.parts, target
        x = (n0 * to_x + h0) // d0
        y = (n1 * to_y + h1) // d1
        z = z0 if to_z == now[2] else (n2 * to_z + h2) // d2
        a = a0 if to_a == now[3] else (n3 * to_a + h3) // d3
        self.parts, self.steps = target, [x, y, z, a]
        return x - x0, y - y0, z - z0, a - a0

    def _rate(self, steps: Steps, pace: Pace, kind: str) -> tuple[float, float]:
        """Pulses/s of X, Y and Z together, or of A alone, and their way in pulses."""
        x, y, z, a = steps
        extent = sqrt(x * x + y * y + z * z)
        length = 0.0
        if extent:
            x_per, y_per, z_per, _ = self._per_unit
            length = extent / x_per if self._is_even else hypot(x / x_per, y / y_per, z / z_per)
            self.lengths[kind] += length
        else:
            extent = abs(a)
            self.turned += extent / self._per_unit[3]
        if pace.seconds:
            rate = extent / pace.seconds
        elif length:
            rate = pace.feed * extent / length
        else:
            rate = pace.turn * self._per_unit[3]
        if pace.cap and length and rate > (most := pace.cap * extent / length):
            self.slowed_arcs += 1
            rate = most
        return rate, extent

    def _bend(self, arc: Arc, plane: tuple[int, int]) -> float:
        """The speed at which the axes' acceleration just keeps them on an arc, mm/s."""
        axes = [axis for index in plane if (axis := self.mill.axes[index])]
        accel = min(axis.accel / self._per_unit[axis.index] for axis in axes)
        return sqrt(accel * arc.radius)

    def _require_reach(self, target: list[int]) -> None:
        for index in self.homed:
            axis = self.mill.axes[index]
            if axis is None or target[index] == self.parts[index]:
                continue
            for limit, word in ((axis.lowest, "lowest"), (axis.highest, "highest")):
                steps = axis.steps_of(target[index])
                if limit is not None and (steps < limit if word == "lowest" else steps > limit):
                    raise OutOfReach(
                        f"{LETTERS[index]} would go to {target[index] / PARTS:g}, beyond its "
                        f"{word} position, {float(limit / axis.steps_per_unit):g} {axis.unit}"
                    )
