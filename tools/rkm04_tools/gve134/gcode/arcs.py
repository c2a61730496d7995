"""Arcs: their centres, and the corners of the chords that stand for them. Lengths in mm."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, sin

CLOSING_MM = 0.005
"""What the rounding of coordinates to three decimals, or four of an inch, leaves open at most."""

CHORD_TURN_MAX = math.pi / 2
"""A chord stands for a quarter of a turn at most, however small the arc is."""

Point = tuple[float, float]


class NoArc(Exception):
    """Why there is no such arc."""


@dataclass(frozen=True, slots=True)
class Arc:
    """An arc around (0, 0): where it begins, how far it turns, positive ones counterclockwise."""

    angle: float
    turn: float
    begin_radius: float
    end_radius: float

    @property
    def radius(self) -> float:
        """The smaller one; they differ by less than what may be open."""
        return min(self.begin_radius, self.end_radius)

    @property
    def length(self) -> float:
        """Along the arc."""
        return abs(self.turn) * (self.begin_radius + self.end_radius) / 2

    def chords(self, tolerance: float) -> int:
        """The fewest chords, of one angle each, that stay within a tolerance of the arc."""
        largest = max(self.begin_radius, self.end_radius)
        most = CHORD_TURN_MAX
        if tolerance < largest:
            most = min(most, 2 * math.acos(1 - tolerance / largest))
        return max(1, math.ceil(abs(self.turn) / most - 1e-9))

    def corners(self, chords: int) -> Iterator[Point]:
        """The ends of the chords but for the last, which is the end of the arc."""
        begin, first, turn = self.begin_radius, self.angle, self.turn
        growth = self.end_radius - begin
        for i in range(1, chords):
            part = i / chords
            radius = begin + growth * part
            angle = first + turn * part
            yield radius * cos(angle), radius * sin(angle)


def arc_around(centre: Point, end: Point, clockwise: bool, closing: float) -> Arc:
    """The arc from (0, 0) to an end around a centre; a whole turn if the end is at (0, 0)."""
    begin_radius = math.hypot(*centre)
    to_end = (end[0] - centre[0], end[1] - centre[1])
    end_radius = math.hypot(*to_end)
    if begin_radius == 0 or end_radius == 0:
        raise NoArc("the arc has no radius: its centre is its start or its end")
    if abs(end_radius - begin_radius) > closing:
        raise NoArc(
            f"the arc does not close: its start is {begin_radius:.4f} mm from the centre, "
            f"its end {end_radius:.4f} mm"
        )
    angle = math.atan2(-centre[1], -centre[0])
    whole = 2 * math.pi
    turn = (math.atan2(to_end[1], to_end[0]) - angle) % whole
    turn = turn - whole if clockwise else turn or whole
    return Arc(angle, turn, begin_radius, end_radius)


def centre_of(end: Point, radius: float, clockwise: bool, closing: float) -> Point:
    """The centre of an arc with a radius; of a negative one it is that of the longer way round."""
    x, y = end
    chord = math.hypot(x, y)
    if chord == 0:
        raise NoArc("an arc with R must end elsewhere than it starts; write a circle with I, J, K")
    if chord / 2 - abs(radius) > closing:
        raise NoArc(
            f"the arc does not close: R{radius:g} mm does not reach the end, {chord:.4f} mm away"
        )
    height = math.sqrt(max(0.0, radius * radius - chord * chord / 4))
    side = -1.0 if clockwise == (radius > 0) else 1.0
    return x / 2 - side * height * y / chord, y / 2 + side * height * x / chord
