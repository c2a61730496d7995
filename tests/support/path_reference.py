"""The exact reference of paths: chains of vectors on four axes, written from the contract alone.

In: vectors with their limits, in the units of the contract: speeds in 1/256 step/s, their squares
whole numbers, accelerations in 1/128 step/s². Out: when each pulse of each axis is due, in ticks
with `ROOT_BITS` binary places. All of it is integers and fractions but for `rough_times`, which
says what it may be wrong by, and finds the pulses that are worth an exact look.

Of a vector the place s runs from 0 to L, the steps of its longest axis; axis j makes its pulse k at
s = k·L/|d_j|. Along a ramp u² is linear in s:

    u²(s) = u0² ± G·(s - s0),     G = 1024·a a step

and the time between two places is (u1 - u0)/A on a ramp, (s1 - s0)/u at constant speed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

from exact import Fraction
from reference import TICK_HZ

ROOT_BITS = 80
"""Binary places of ticks and speeds."""

NEARLY_BITS = 40
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

    @cached_property
    def length(self) -> int:
        """L."""
        return max(map(abs, self.steps))

    def to_border(self, square: int) -> int:
        """The square of a speed of this vector in terms of borders: divided by κ = L²/E²."""
        return square * (self.extent2 or self.length**2) // self.length**2

    def to_border_up(self, square: int) -> int:
        """The same, rounded up."""
        return -self.to_border(-square)

    def from_border(self, square: int) -> int:
        """The square of a speed at a border in the vector's own terms: times κ."""
        return square * self.length**2 // (self.extent2 or self.length**2)

    @property
    def border_gain(self) -> int:
        """g: G·L in terms of borders."""
        return self.gain * (self.extent2 or self.length**2) // self.length

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
            caps.append(after.to_border(max(0, reach - gained) ** 2))
    return min(caps, default=None)


def border_cap(before: Vector, after: Vector, turn_us: int) -> int:
    """C of the border between two vectors."""
    caps = [v.to_border(v.speed**2) for v in (before, after)]
    turn = turn_cap(before, after, turn_us)
    return min(*caps, after.border**2, *([] if turn is None else [turn]))


def at_once(vector: Vector, square: int, start2: int, most: int) -> int:
    """The square of the speed after a start or a change, which takes speeds up to S at once."""
    if square > vector.speed**2:
        return vector.speed**2 if square <= start2 else square
    return max(square, min(vector.speed**2, start2, most))


@dataclass(frozen=True)
class Limits:
    """What a path keeps besides the limits of its vectors."""

    turn_us: int
    start_speed: int = 0
    """S, in 1/256 step/s of the longest axis."""

    @property
    def start2(self) -> int:
        """S²."""
        return self.start_speed**2


Ends = list[tuple[int, int]]
"""Of each vector the squares of the speed with which it is entered and left."""


def backward(vectors: Sequence[Vector], limits: Limits) -> list[int]:
    """Return the squares of the speeds at the ends of vectors that can be braked from there."""
    borders = [0] * len(vectors)
    borders[-1] = vectors[-1].to_border(min(limits.start2, vectors[-1].speed ** 2))
    for i in range(len(vectors) - 2, -1, -1):
        cap = border_cap(vectors[i], vectors[i + 1], limits.turn_us)
        borders[i] = min(cap, borders[i + 1] + vectors[i + 1].border_gain)
    return borders


def forward(vectors: Sequence[Vector], borders: list[int], first: int, before: int) -> None:
    """Lower (or raise, where a path is too fast) borders from one on to what is reached."""
    for i in range(first, len(vectors)):
        gain = vectors[i].border_gain
        borders[i] = before = max(min(borders[i], before + gain), before - gain)


def look(
    vectors: Sequence[Vector], place: Fraction, square: int, limits: Limits, cap: int | None
) -> tuple[Ends, list[int]]:
    """Look ahead over vectors, of which the first goes on from a place with the square of a speed.

    That may change at once there, as S allows, but to no more than a cap. Returns the borders, too.
    """
    borders = backward(vectors, limits)
    first = vectors[0]
    way = whole(first.gain * (first.length - place))
    brakeable = first.from_border(borders[0]) + way
    most = brakeable if cap is None else min(brakeable, cap)
    square = at_once(first, square, limits.start2, most)
    borders[0] = min(borders[0], first.to_border(square + way))
    leave = first.from_border(borders[0])
    fall = max(0, limits.start2 - first.speed**2) if square > first.speed**2 else 0
    if leave + fall < square - way:
        leave = square - way
        borders[0] = first.to_border_up(leave)
    forward(vectors, borders, 1, borders[0])
    return [(square, leave), *ends_of(vectors[1:], borders)], borders


def look_again(vectors: Sequence[Vector], border: int, limits: Limits) -> tuple[Ends, list[int]]:
    """Look ahead over vectors that a path comes to with the square of a speed at a border."""
    borders = backward(vectors, limits)
    forward(vectors, borders, 0, border)
    return ends_of(vectors, [border, *borders]), borders


def ends_of(vectors: Sequence[Vector], borders: Sequence[int]) -> Ends:
    """With what vectors are entered and left; the first border is that before the first."""
    return [
        (v.from_border(a), v.from_border(b))
        for v, (a, b) in zip(vectors, pairwise(borders), strict=True)
    ]


def look_for_rest(
    vectors: Sequence[Vector], place: Fraction, square: int, limits: Limits
) -> tuple[Ends, bool]:
    """Brake to S as soon as that can be; tells whether the path rests in the last of the vectors.

    If not, it rests at its end.
    """
    first = vectors[0]
    least = square - whole(first.gain * (first.length - place))
    if least <= limits.start2:
        return [(square, limits.start2)], True
    ends = [(square, least)]
    border = first.to_border_up(least)
    for vector in vectors[1:]:
        enter = vector.from_border(border)
        border -= vector.border_gain
        if border <= vector.to_border(limits.start2):
            return [*ends, (enter, limits.start2)], True
        ends.append((enter, vector.from_border(border)))
    return ends, False


def whole(number: Fraction | int) -> int:
    """Return a number that must be whole."""
    assert Fraction(number).denominator == 1
    return int(number)


@dataclass(frozen=True)
class Leg:
    """Motion along a vector on a ramp up (sign 1), down (-1) or at constant speed (0).

    Places are whole numbers of 1/2G step, so that 2·u² changes by one on the way between two; the
    corner where two ramps meet is one of them, as half of the sum of three even numbers is whole.
    """

    vector: int
    per_step: int
    """2G."""
    x0: int
    x1: int | Fraction
    """A fraction only where the path was changed."""
    square: int
    """2·u² at x0."""
    sign: int
    time: int
    """At x0: ticks, scaled by 2^ROOT_BITS."""

    def place(self, x: Fraction | int) -> Fraction:
        """A place in steps as these numbers."""
        return Fraction(x * self.per_step)

    def square_at(self, x: Fraction | int) -> Fraction:
        """u² at a place, given in steps."""
        return (self.square + self.sign * (self.place(x) - self.x0)) / 2

    def time_at(self, x: Fraction | int) -> int:
        """When the path is at a place, given in steps."""
        place = self.place(x)
        return self.time + self._time_of_way(place.numerator, place.denominator)

    @cached_property
    def end_time(self) -> int:
        """When the leg ends."""
        return self.time + self._time_of_way(self.x1.numerator, self.x1.denominator)

    @property
    def square_at_end(self) -> int | Fraction:
        """2·u² at x1."""
        return self.square + self.sign * (self.x1 - self.x0)

    @cached_property
    def _root(self) -> int:
        return _root(self.square, 1)

    def _time_of_way(self, x: int, divisor: int) -> int:
        """The time from x0 to the place x/divisor."""
        way = x - self.x0 * divisor
        if self.sign == 0:
            scaled = way * TICK_HZ * SPEED_UNITS << 2 * ROOT_BITS
            return scaled // (divisor * self.per_step * self._root)
        change = abs(_root(self.square * divisor + self.sign * way, divisor) - self._root)
        return change * TICK_HZ * GAIN_PER_ACCEL // self.per_step

    def pulses(self, length: int, steps: int) -> range:
        """The numbers in the vector of an axis' pulses on the leg."""
        divisor = length * self.per_step
        return range(self.x0 * steps // divisor + 1, self.x1 * steps // divisor + 1)

    def pulse_time(self, length: int, steps: int, pulse: int) -> int:
        """When a pulse of an axis is due, ticks scaled by 2^ROOT_BITS."""
        return self.time + self._time_of_way(pulse * length * self.per_step, steps)

    @cached_property
    def is_short(self) -> bool:
        """Whether floating-point numbers tell times on the leg to 2^-16 tick.

        They have 53 digits, and `rough_times` loses at most four of them.
        """
        return self.end_time - self.time < 1 << 33 + ROOT_BITS

    def rough_times(self, length: int, steps: int, pulses: Iterable[int]) -> list[float]:
        """When these pulses of an axis are due: ticks from the beginning of the leg.

        On a ramp u1 - u0 = (u1² - u0²) / (u1 + u0): nothing that is nearly the same is subtracted.
        """
        per_pulse, before = length * self.per_step, self.x0 * steps
        root = self._root / 2**ROOT_BITS
        if self.sign == 0:
            scale = TICK_HZ * SPEED_UNITS / (steps * self.per_step * root)
            return [(per_pulse * k - before) * scale for k in pulses]
        scale = TICK_HZ * GAIN_PER_ACCEL / (2 * steps * self.per_step)
        square, twice, sign, sqrt = self.square * steps, 2 * steps, self.sign, math.sqrt
        return [
            way * scale / (root + sqrt((square + sign * way) / twice))
            for way in (per_pulse * k - before for k in pulses)
        ]


def _root(square: int, divisor: int) -> int:
    """√(square / 2·divisor), scaled by 2^ROOT_BITS."""
    return math.isqrt((square << 2 * ROOT_BITS) // (2 * divisor))


def corners(
    vector: Vector, place: int, ends: tuple[int, int], speed: int, start2: int
) -> Iterator[tuple[int, int, int]]:
    """The legs of a vector from a place on: end, 2·u² at the beginning, sign."""
    enter, leave = 2 * ends[0], 2 * ends[1]
    end = 2 * vector.gain * vector.length
    limit = max(2 * speed**2, leave)
    if enter <= limit:
        peak = min(limit, (enter + leave + end - place) // 2)
        first, sign = place + peak - enter, 1
    else:
        turn = min(enter, max(limit, 2 * start2))
        peak, first, sign = limit, place + enter - turn, -1
    yield first, enter, sign
    yield end - (peak - leave), peak, 0
    yield end, peak, -1


def braking(place: int, ends: tuple[int, int]) -> Iterator[tuple[int, int, int]]:
    """The leg of a vector in which a stop rests."""
    enter, leave = 2 * ends[0], 2 * ends[1]
    yield place + max(0, enter - leave), enter, -1


def lay(
    index: int, per_step: int, place: int, time: int, course: Iterable[tuple[int, int, int]]
) -> list[Leg]:
    """The legs of a vector from a place, one after the other."""
    legs: list[Leg] = []
    for end, square, sign in course:
        if end > place:
            legs.append(Leg(index, per_step, place, end, square, sign, time))
            place, time = end, legs[-1].end_time
    return legs


@dataclass
class Path:
    """A path as it was made: its legs in the order of time."""

    vectors: list[Vector]
    known: int
    limits: Limits
    legs: list[Leg] = field(default_factory=list)
    rest: tuple[int, Fraction] = (0, Fraction(0))

    def start(self, tick: int) -> None:
        """Leave the stand at a tick."""
        vector, place = self.rest
        self.begun, self.begin_tick = self.rest, tick
        self._plan(vector, place, 0, tick << ROOT_BITS, stops=False)

    def start_again(self, *, stops: bool = False) -> None:
        """Plan anew from where the stand was last left."""
        self._cut(*self.begun)
        self._plan(*self.begun, 0, self.begin_tick << ROOT_BITS, stops=stops)

    def join(self, vector: int) -> None:
        """Plan anew from the border before a vector, for those that have been added."""
        time = self._leg_at(vector - 1, Fraction(self.vectors[vector - 1].length)).end_time
        self._cut(vector, Fraction(0))
        ahead = self.vectors[vector : self.known]
        ends, borders = look_again(ahead, self._borders[vector], self.limits)
        self._borders |= dict(enumerate(borders, start=vector + 1))
        self._lay(vector, Fraction(0), time, ends, stops=False, rests=False)

    def check(self, vector: int, place: Fraction, tick: int) -> None:
        """Refuse a place that comes before a tick, or a whole step that is not the first one."""
        if (vector, place) == self.begun:
            if self.begin_tick < tick:
                raise AssertionError(f"vector {vector}, step {place}: before {tick}")
            return
        leg = self._leg_at(vector, place)
        nearly = 1 << ROOT_BITS // 2
        if leg.time_at(place) + nearly < tick << ROOT_BITS:
            raise AssertionError(f"vector {vector}, step {place}: before {tick}")
        before = place - 1
        if place.denominator > 1 or leg.place(before) <= leg.x0:
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
        square = whole(at.square_at(place))
        self._cut(vector, place)
        cap = self._turn_cap(vector, place)
        self._plan(vector, place, square, time, stops=stops, cap=cap)
        return None

    def _change_at_border(self, vector: int, time: int, *, stops: bool) -> None:
        rests = self.rest == (vector + 1, Fraction(0))
        square = 0 if rests else self._enters[vector + 1]
        self._cut(vector, Fraction(self.vectors[vector].length))
        cap = self._turn_cap(vector + 1, Fraction(0))
        self._plan(vector + 1, Fraction(0), square, time, stops=stops, cap=cap)

    def _turn_cap(self, vector: int, place: Fraction) -> int | None:
        """How fast a change may make it at once if an axis that turned has yet to make a pulse."""
        if vector in (0, self.begun[0]):
            return None
        before, after = self.vectors[vector - 1 : vector + 1]
        turned = (e for d, e in zip(before.steps, after.steps, strict=True) if d * e < 0)
        if all(place * abs(e) >= after.length for e in turned):
            return None
        turn = turn_cap(before, after, self.limits.turn_us)
        return after.from_border(min(after.border**2, turn or 0))

    def _leg_at(self, vector: int, place: Fraction) -> Leg:
        legs = [
            leg
            for leg in self.legs
            if leg.vector == vector and leg.x0 <= leg.place(place) <= leg.x1
        ]
        return legs[-1]

    def _cut(self, vector: int, place: Fraction) -> None:
        kept = [leg for leg in self.legs if (leg.vector, leg.x0) < (vector, leg.place(place))]
        if kept and kept[-1].vector == vector:
            last = kept[-1]
            kept[-1] = replace(last, x1=min(last.x1, last.place(place)))
        self.legs = kept

    def _plan(
        self,
        vector: int,
        place: Fraction,
        square: int,
        time: int,
        *,
        stops: bool,
        cap: int | None = None,
    ) -> None:
        ahead = self.vectors[vector : self.known]
        self._borders = {}
        self.planned_from = vector
        rests = False
        if stops:
            squares, rests = look_for_rest(ahead, place, square, self.limits)
        else:
            squares, borders = look(ahead, place, square, self.limits, cap)
            self._borders = dict(enumerate(borders, start=vector + 1))
        self._lay(vector, place, time, squares, stops=stops, rests=rests)

    def _lay(
        self, vector: int, place: Fraction, time: int, squares: Ends, *, stops: bool, rests: bool
    ) -> None:
        self._enters = {vector + i: enter for i, (enter, _) in enumerate(squares)}
        ahead = self.vectors[vector : vector + len(squares)]
        for i, (each, ends) in enumerate(zip(ahead, squares, strict=True), start=vector):
            at = whole(2 * each.gain * place) if i == vector else 0
            start2 = self.limits.start2 if i == vector and not stops else 0
            course = corners(each, at, ends, 0 if stops else each.speed, start2)
            if rests and i + 1 == vector + len(squares):
                course = braking(at, ends)
            legs = lay(i, 2 * each.gain, at, time, course)
            self.legs += legs
            if legs:
                at, time = whole(legs[-1].x1), legs[-1].end_time
        end = 2 * each.gain * each.length
        self.rest_time = time
        self.rest = (i + 1, Fraction(0)) if at == end else (i, Fraction(at, 2 * each.gain))

    def rest_ticks(self) -> set[int]:
        """The whole tick at or after the rest; the next one too, where it rests on a whole tick.

        As the firmware's times are a little wrong, that is within 2^-NEARLY_BITS tick.
        """
        time, nearly = self.rest_time, 1 << ROOT_BITS - NEARLY_BITS
        return {-((nearly - time) >> ROOT_BITS), -((-nearly - time) >> ROOT_BITS)}

    def stretches(self, axis: int) -> Iterator[tuple[Leg, int, int, range]]:
        """The legs with pulses of an axis: leg, L, the axis' steps, the pulses' numbers in it."""
        for leg in self.legs:
            vector = self.vectors[leg.vector]
            steps = vector.steps[axis]
            if steps != 0:
                pulses = leg.pulses(vector.length, abs(steps))
                if pulses:
                    yield leg, vector.length, steps, pulses

    def count(self, axis: int) -> int:
        """How many pulses an axis makes."""
        return sum(len(pulses) for *_, pulses in self.stretches(axis))
