"""The exact reference of paths: chains of vectors on four axes, written from the contract alone.

In: vectors with their limits, in the units of the contract: speeds in 1/256 step/s, their squares
whole numbers, accelerations in 1/128 step/s². Out: when each pulse of each axis is due, in ticks
with `FRACTION_BITS` binary places. All of it is integers and fractions; roots are taken with
`ROOT_BITS` binary places.

Of a vector the place s runs from 0 to L, the steps of its longest axis; axis j makes its pulse k at
s = k·L/|d_j|. Along a ramp u² is linear in s:

    u²(s) = u0² ± G·(s - s0),     G = 1024·a a step

and the time between two places is (u1 - u0)/A on a ramp, (s1 - s0)/u at constant speed.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

from reference import TICK_HZ

FRACTION_BITS = 32
"""Binary places of a tick after the point."""

ROOT_BITS = 80
AXES = 4
SPEED_UNITS = 256
ACCEL_UNITS = 128
GAIN_PER_ACCEL = 1024


@dataclass(frozen=True)
class Vector:
    """Steps of the four axes, and what limits the speed along them."""

    steps: tuple[int, int, int, int]
    speed: int
    accel: int
    border: int = 2**32 - 1
    extent2: int = 0
    """E², the square of the length that border speeds count; 0: that of the longest axis."""

    @property
    def length(self) -> int:
        """L."""
        return max(map(abs, self.steps))

    @property
    def kappa(self) -> Fraction:
        """What makes a square of this vector's speed of one of a border."""
        return Fraction(self.length**2, self.extent2 or self.length**2)

    @property
    def gain(self) -> int:
        """G."""
        return GAIN_PER_ACCEL * self.accel


def turn_cap(before: Vector, after: Vector, turn_us: int) -> int | None:
    """The square of the speed at a border that axes which turn there allow; None: any."""
    caps = []
    for d, e in zip(before.steps, after.steps, strict=True):
        if d * e < 0:
            reach = SPEED_UNITS * 10**6 * after.length // (turn_us * abs(e))
            gained = -(-SPEED_UNITS * after.accel * turn_us // (ACCEL_UNITS * 2 * 10**6))
            caps.append(math.floor(max(0, reach - gained) ** 2 / after.kappa))
    return min(caps, default=None)


def border_cap(before: Vector, after: Vector, turn_us: int) -> int:
    """C of the border between two vectors."""
    caps = [math.floor(v.speed**2 / v.kappa) for v in (before, after)]
    turn = turn_cap(before, after, turn_us)
    return min(*caps, after.border**2, *([] if turn is None else [turn]))


def look(
    vectors: Sequence[Vector], place: Fraction, square: int, turn_us: int, *, stops: bool
) -> list[tuple[int, int]]:
    """Look ahead over vectors, of which the first goes on from a place with the square of a speed.

    Returns for each the squares of its speed at its beginning (or that place) and at its end.
    """
    borders = [0] * len(vectors)
    for i in range(len(vectors) - 2, -1, -1):
        gain = math.floor(vectors[i + 1].gain * vectors[i + 1].length / vectors[i + 1].kappa)
        cap = border_cap(vectors[i], vectors[i + 1], turn_us)
        borders[i] = 0 if stops else min(cap, borders[i + 1] + gain)
    first = vectors[0]
    way = first.gain * (first.length - place)
    assert way.denominator == 1
    borders[0] = min(borders[0], math.floor((square + way) / first.kappa))
    exits = [math.floor(borders[0] * first.kappa)]
    if exits[0] < square - way:
        exits[0] = int(square - way)
        borders[0] = math.ceil(exits[0] / first.kappa)
    for i in range(1, len(vectors)):
        gain = math.floor(vectors[i].gain * vectors[i].length / vectors[i].kappa)
        borders[i] = max(min(borders[i], borders[i - 1] + gain), borders[i - 1] - gain)
        exits.append(math.floor(borders[i] * vectors[i].kappa))
    enters = [square]
    enters += [math.floor(borders[i - 1] * vectors[i].kappa) for i in range(1, len(vectors))]
    return list(zip(enters, exits, strict=True))


@dataclass(frozen=True)
class Leg:
    """Motion from place x0 to x1 of a vector, u² = square + slope·(s - x0)."""

    vector: int
    x0: Fraction
    x1: Fraction
    square: int | Fraction
    slope: int
    time: int
    """At x0: ticks, scaled by 2^ROOT_BITS."""

    def square_at(self, x: Fraction | int) -> Fraction:
        """u² at a place."""
        return self.square + self.slope * (x - self.x0)

    def time_at(self, x: Fraction | int) -> int:
        """When the path is at a place."""
        if self.slope == 0:
            return self.time + _cruise_ticks(Fraction(x - self.x0), self.square)
        change = abs(_root(self.square_at(x)) - _root(self.square))
        return self.time + change * TICK_HZ * GAIN_PER_ACCEL // (2 * abs(self.slope))

    def pulses(self, length: int, steps: int) -> range:
        """The numbers in the vector of an axis' pulses on the leg."""
        first = math.floor(self.x0 * steps / length) + 1
        return range(first, math.floor(self.x1 * steps / length) + 1)

    def times(self, length: int, steps: int, pulses: Iterable[int]) -> Iterator[int]:
        """When these pulses of an axis are due, ticks scaled by 2^FRACTION_BITS."""
        down = ROOT_BITS - FRACTION_BITS
        x0, square = Fraction(self.x0), Fraction(self.square)
        begin = _root(square)
        if self.slope == 0:
            divisor = x0.denominator * steps * begin
            for k in pulses:
                way = k * length * x0.denominator - x0.numerator * steps
                ticks = (way * TICK_HZ * SPEED_UNITS << 2 * ROOT_BITS) // divisor
                yield (self.time + ticks) >> down
            return
        # u²(k) = (constant + factor·k) / scale
        origin = square - self.slope * x0
        scale, divisor = origin.denominator * steps, 2 * abs(self.slope)
        constant, factor = origin.numerator * steps, self.slope * length * origin.denominator
        for k in pulses:
            root = math.isqrt(((constant + factor * k) << 2 * ROOT_BITS) // scale)
            ticks = abs(root - begin) * TICK_HZ * GAIN_PER_ACCEL // divisor
            yield (self.time + ticks) >> down


def _root(square: Fraction | int) -> int:
    """√square, scaled by 2^ROOT_BITS."""
    square = Fraction(square)
    return math.isqrt((square.numerator << 2 * ROOT_BITS) // square.denominator)


def _cruise_ticks(way: Fraction, square: Fraction | int) -> int:
    ticks = way.numerator * TICK_HZ * SPEED_UNITS << 2 * ROOT_BITS
    return ticks // (way.denominator * _root(square))


def lay(
    vector: Vector, index: int, place: Fraction, squares: tuple[int, int], time: int, speed: int
) -> list[Leg]:
    """The legs of a vector from a place to its end, or to where it comes to rest."""
    enter, leave = squares
    gain, length = vector.gain, vector.length
    limit = max(speed**2, leave)
    legs: list[Leg] = []
    if enter <= limit:
        peak = min(Fraction(limit), Fraction(enter + leave + gain * (length - place)) / 2)
        up, slope = place + (peak - enter) / gain, gain
    else:
        peak, up, slope = Fraction(limit), place + Fraction(enter - limit, gain), -gain
    down = length - (peak - leave) / gain
    corners = [(place, up, Fraction(enter), slope), (up, down, peak, 0)]
    corners.append((down, Fraction(length), peak, -gain))
    for x0, x1, square, change in corners:
        if x1 > x0 and (square > 0 or change > 0):
            legs.append(Leg(index, x0, x1, square, change, time))
            time = legs[-1].time_at(x1)
    return legs


@dataclass
class Path:
    """A path as it was made: its legs in the order of time."""

    vectors: list[Vector]
    known: int
    turn_us: int
    legs: list[Leg] = field(default_factory=list)
    rest: tuple[int, Fraction] = (0, Fraction(0))

    def start(self, tick: int) -> None:
        """Leave the stand at a tick."""
        vector, place = self.rest
        self.begun, self.begin_tick = self.rest, tick
        self._plan(vector, place, 0, tick << ROOT_BITS, stops=False)

    def start_again(self) -> None:
        """Plan anew from where the stand was last left."""
        self.rest = self.begun
        self._cut(*self.rest)
        self.start(self.begin_tick)

    def check(self, vector: int, place: Fraction, tick: int) -> None:
        """Refuse a place that comes before a tick, or a whole step that is not the first one."""
        leg = self._leg_at(vector, place)
        nearly = 1 << ROOT_BITS // 2
        if leg.time_at(place) + nearly < tick << ROOT_BITS:
            raise AssertionError(f"vector {vector}, step {place}: before {tick}")
        before = place - 1
        if place.denominator > 1 or before <= leg.x0:
            return
        if leg.time_at(before) - nearly > tick << ROOT_BITS:
            raise AssertionError(
                f"vector {vector}, step {place}: later than the first after {tick}"
            )

    def change(self, vector: int, place: Fraction, *, stops: bool) -> None:
        """Plan anew from a place that the path passes."""
        at = self._leg_at(vector, place)
        time = at.time_at(place)
        if place == self.vectors[vector].length:
            return self._change_at_border(vector, time, stops=stops)
        square = at.square_at(place)
        assert square.denominator == 1
        self._cut(vector, place)
        self._plan(vector, place, int(square), time, stops=stops)
        return None

    def _change_at_border(self, vector: int, time: int, *, stops: bool) -> None:
        square = self._squares[vector + 1]
        self._cut(vector, Fraction(self.vectors[vector].length))
        self._plan(vector + 1, Fraction(0), square, time, stops=stops)

    def _leg_at(self, vector: int, place: Fraction) -> Leg:
        legs = [leg for leg in self.legs if leg.vector == vector and leg.x0 <= place <= leg.x1]
        return legs[-1]

    def _cut(self, vector: int, place: Fraction) -> None:
        kept = [leg for leg in self.legs if (leg.vector, leg.x0) < (vector, place)]
        if kept and kept[-1].vector == vector:
            kept[-1] = replace(kept[-1], x1=min(kept[-1].x1, place))
        self.legs = kept

    def _plan(self, vector: int, place: Fraction, square: int, time: int, *, stops: bool) -> None:
        ahead = self.vectors[vector : self.known]
        squares = look(ahead, place, square, self.turn_us, stops=stops)
        self._squares = {vector + i: enter for i, (enter, _) in enumerate(squares)}
        for i, (each, ends) in enumerate(zip(ahead, squares, strict=True), start=vector):
            at = place if i == vector else Fraction(0)
            legs = lay(each, i, at, ends, time, 0 if stops else each.speed)
            self.legs += legs
            end = legs[-1].x1 if legs else at
            time = legs[-1].time_at(end) if legs else time
            if (stops and ends[1] == 0) or i + 1 == self.known:
                self.rest = (i + 1, Fraction(0)) if end == each.length else (i, end)
                break

    def rest_tick(self) -> int:
        """When the path comes to rest, rounded down to a tick."""
        last = self.legs[-1]
        return last.time_at(last.x1) >> ROOT_BITS

    def pulses(self, axis: int, wanted: Sequence[int] | None = None) -> Iterator[tuple[int, int]]:
        """Direction and time of the pulses of an axis: of all, or of those of these ordinals."""
        made = 0
        for leg in self.legs:
            vector = self.vectors[leg.vector]
            steps = vector.steps[axis]
            if steps == 0:
                continue
            pulses: Sequence[int] = leg.pulses(vector.length, abs(steps))
            shift = made - pulses[0] + 1 if pulses else 0
            made += len(pulses)
            if wanted is not None and pulses:
                low, high = (bisect_right(wanted, n) for n in (made - len(pulses), made))
                pulses = [n - shift for n in wanted[low:high]]
            for time in leg.times(vector.length, abs(steps), pulses):
                yield (1 if steps > 0 else -1), time

    def count(self, axis: int) -> int:
        """How many pulses an axis makes."""
        ranges = (
            leg.pulses(self.vectors[leg.vector].length, abs(self.vectors[leg.vector].steps[axis]))
            for leg in self.legs
            if self.vectors[leg.vector].steps[axis] != 0
        )
        return sum(map(len, ranges))
