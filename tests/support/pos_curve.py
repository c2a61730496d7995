"""The exact curve of one axis of the positioning unit, written from the contract alone.

Places are steps from where the measure begins, counted in its direction; squares of speeds are
doubled, so that the speed at which two ramps meet is whole, too: 2·v², v in 1/256 step/s. Times are
ticks with `BITS` binary places. All of it is integers and fractions; only `Leg.ticks`, of many
pulses at once, is made of floats, each wrong by less than 2^-50 of the time in its leg.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from exact import Fraction
from numpy.typing import NDArray
from pos_words import SPEED_UNITS, Unsure
from reference import TICK_HZ

BITS = 96
SLOWEST = 1 / TICK_HZ / 256
"""Steps per tick."""

GAIN = 1024
"""v² changes by 1024·a a step."""

Place = int | Fraction
Ticks = NDArray[np.float64]
Numbers = NDArray[np.int64]


def root(square2: Place) -> int:
    """The speed that belongs to a doubled square, scaled by 2^BITS."""
    return math.isqrt((square2.numerator << 2 * BITS) // (2 * square2.denominator))


@dataclass(frozen=True)
class Leg:
    """A ramp up (sign 1) or down (-1), or a way at constant speed (0)."""

    x0: Fraction
    x1: Fraction
    square2: Fraction
    sign: int
    accel: int
    time: int

    @property
    def gain2(self) -> int:
        """By how much the doubled square changes in a step."""
        return 2 * GAIN * self.accel * self.sign

    def square2_at(self, x: Place) -> Fraction:
        """The doubled square of the speed at a place."""
        return Fraction(self.square2 + self.gain2 * (x - self.x0))

    def time_at(self, x: Place) -> int:
        """When the axis is at a place."""
        if self.sign == 0:
            scaled = Fraction(x - self.x0) * SPEED_UNITS * TICK_HZ
            return self.time + (scaled.numerator << 2 * BITS) // (
                scaled.denominator * root(self.square2)
            )
        change = abs(root(self.square2_at(x)) - root(self.square2))
        return self.time + change * TICK_HZ // (2 * self.accel)

    def place_at(self, time: int) -> Fraction:
        """Where the axis is at a time, to 2^-BITS step or so."""
        ticks, unit = time - self.time, (SPEED_UNITS * TICK_HZ * TICK_HZ) << 2 * BITS
        way = ticks * (root(self.square2) * TICK_HZ + self.sign * self.accel * ticks)
        x0 = self.x0
        return Fraction(x0.numerator * unit + way * x0.denominator, x0.denominator * unit)

    @cached_property
    def end_time(self) -> int:
        """When the leg ends."""
        return self.time_at(self.x1)

    @cached_property
    def pulses(self) -> range:
        """The numbers of its pulses."""
        return range(math.floor(self.x0) + 1, math.floor(self.x1) + 1)

    def ticks(self, numbers: Numbers, base: int) -> Ticks:
        """When these pulses are due: ticks after the tick `base`.

        Nothing that is nearly the same is subtracted: way over mean speed, and a ramp down seen
        from its end.
        """
        begin = (self.time - (base << BITS)) / (1 << BITS)
        whole = math.floor(self.x0)
        way = (numbers - whole) - float(self.x0 - whole)
        first = math.sqrt(self.square2 / 2)
        last: Ticks | float = first
        if self.sign > 0:
            last = np.sqrt(first * first + GAIN * self.accel * way)
        elif self.sign < 0:
            end = math.floor(self.x1)
            left = (end - numbers) + float(self.x1 - end)
            last = np.sqrt(float(self.square2_at(self.x1)) / 2 + GAIN * self.accel * left)
        return np.asarray(begin + way * (2.0 * SPEED_UNITS * TICK_HZ) / (first + last), np.float64)


@dataclass(frozen=True)
class Order:
    """What is wanted: the speed W (0: stand), S, the acceleration, and N, where the measure ends.

    W and S in 1/256 step/s, the acceleration in 1/128 step/s².
    """

    speed: int
    start_speed: int
    accel: int
    end: int


def corners(
    x: Fraction, square2: Fraction, order: Order
) -> Iterator[tuple[Fraction, Fraction, int]]:
    """The legs from a place and a speed: where each ends, its first doubled square, its sign."""
    wanted, start = Fraction(2 * order.speed**2), Fraction(2 * order.start_speed**2)
    gain2, end = 2 * GAIN * order.accel, Fraction(order.end)
    if not order.speed:
        rest = x + (max(square2, start) - start) / gain2
        if rest > end:
            raise Unsure("the brake of a fault is too weak for what is left of the measure")
        yield rest, square2, -1
        return
    if square2 <= start:
        square2 = min(start, wanted)
    if max(square2, wanted) <= start:
        yield end, square2, 0
        return
    limit = max(wanted, start)
    if square2 <= limit:
        peak = min(limit, (square2 + start + gain2 * (end - x)) / 2)
        turn, sign = x + (peak - square2) / gain2, 1
    else:
        peak, sign = limit, -1
        turn = x + (square2 - limit) / gain2
    down = end - (peak - start) / gain2
    yield min(turn, end), square2, sign
    yield down, min(peak, wanted), 0
    yield end, peak, -1


@dataclass(frozen=True)
class Curve:
    """A motion of an axis to its rest: at N, or at a real place where it stands."""

    legs: tuple[Leg, ...]
    rest: Fraction
    rest_time: int
    """When it stands."""
    end: int
    """N."""
    blur: float = 0.0
    """By how many steps it may be wrong, as pulses did not tell where a change took effect."""
    blur_ticks: float = 0.0
    """By how many ticks more it may be wrong, as it was changed at pulses when it was wrong."""
    start: int = -1
    """Which leg is the first after a stand; -1: none."""

    @property
    def reaches(self) -> bool:
        """Whether it rests at the end of the measure."""
        return self.rest == self.end

    @property
    def count(self) -> int:
        """Its last pulse."""
        return math.floor(self.rest)

    @property
    def next(self) -> int:
        """Its first pulse, made or not."""
        return math.floor(self.legs[0].x0 if self.legs else self.rest) + 1

    def leg_at(self, x: Place) -> Leg | None:
        """The leg that is over at a place or later; None: it begins there, or rests."""
        return next((leg for leg in self.legs if leg.x0 < x <= leg.x1), None)

    def time_of(self, pulse: int) -> int:
        """When a pulse is due."""
        leg = self.leg_at(pulse)
        assert leg is not None, pulse
        return leg.time_at(pulse)

    def ticks(self, first: int, last: int, base: int) -> Ticks:
        """When the pulses from `first` to `last` are due, after a tick; never: infinity."""
        result = np.full(last - first + 1, np.inf)
        for leg in self.legs:
            low, high = max(first, leg.pulses.start), min(last, leg.pulses.stop - 1)
            if low <= high:
                result[low - first : high - first + 1] = leg.ticks(np.arange(low, high + 1), base)
        return result

    def speeds(self, first: int, last: int) -> Ticks:
        """The speeds at the pulses from `first` to `last`, in steps per tick; 0 for none."""
        squares2 = np.zeros(last - first + 1)
        for leg in self.legs:
            low, high = max(first, leg.pulses.start), min(last, leg.pulses.stop - 1)
            if low <= high:
                way = np.arange(low, high + 1) - float(leg.x0)
                squares2[low - first : high - first + 1] = float(leg.square2) + leg.gain2 * way
        return np.sqrt(np.maximum(squares2, 0) / 2) / SPEED_UNITS / TICK_HZ

    def speed_after(self, time: int) -> float:
        """The speed at a time, in steps per tick."""
        for leg in self.legs:
            if time < leg.end_time:
                first = math.sqrt(leg.square2 / 2)
                change = leg.sign * leg.accel * max(0, time - leg.time) / (TICK_HZ << BITS)
                return (first + 2 * change) / SPEED_UNITS / TICK_HZ
        return 0.0

    def shifted(self, time: int) -> Curve:
        """The same curve, later."""
        legs = tuple(replace(leg, time=leg.time + time) for leg in self.legs)
        return replace(self, legs=legs, rest_time=self.rest_time + time)

    def place_at(self, time: int) -> Fraction:
        """Where the axis is at a time."""
        for leg in self.legs:
            if time <= leg.end_time:
                return leg.place_at(max(time, leg.time))
        return self.rest

    def changed(self, x: Place, order: Order) -> Curve:
        """The curve on which something else is wanted from a place on, if it comes there."""
        if not self.legs or not self.legs[0].x0 <= x <= self.rest:
            return self
        leg = self.leg_at(x) or self.legs[0]
        at, time = leg.square2_at(x), leg.time_at(x)
        kept = [each for each in self.legs if each.x0 < x]
        if kept:
            kept[-1] = replace(kept[-1], x1=Fraction(x))
        legs = (*kept, *lay(Fraction(x), at, time, order))
        speed = max(math.sqrt(at / 2) / SPEED_UNITS / TICK_HZ, SLOWEST)
        # a curve that is ahead by `blur` has the speed of a place so far ahead: it gains by it
        blur_ticks = self.blur_ticks + self.blur / speed
        curve = finished(legs, Fraction(x), time, order.end, self.blur)
        return replace(curve, start=self.start, blur_ticks=blur_ticks)

    def waits(self, tick: int) -> bool:
        """Whether it has not left the stand at a tick."""
        leaves = 0 <= self.start < len(self.legs)
        return leaves and self.legs[self.start].time >= tick << BITS

    def restarted(self, order: Order) -> Curve:
        """The curve that leaves the stand at the same time, as something else is wanted."""
        leg, before = self.legs[self.start], self.legs[: self.start]
        again = (*before, *lay(leg.x0, Fraction(0), leg.time, order))
        curve = finished(again, leg.x0, leg.time, order.end, self.blur)
        return replace(curve, start=self.start if len(again) > len(before) else -1)


def lay(x: Fraction, square2: Fraction, time: int, order: Order) -> list[Leg]:
    """The legs from a place, one after the other."""
    legs: list[Leg] = []
    for end, first2, sign in corners(x, square2, order):
        if end > x:
            legs.append(Leg(x, end, first2, sign, order.accel, time))
            x, time = end, legs[-1].end_time
    return legs


def finished(legs: tuple[Leg, ...], x: Fraction, time: int, end: int, blur: float) -> Curve:
    """The curve of some legs, which stands at a place at once if there is none."""
    if legs:
        x, time = legs[-1].x1, legs[-1].end_time
    return Curve(legs, x, time, end, blur)


def started(x: Place, time: int, order: Order, blur: float = 0.0) -> Curve:
    """The curve that leaves a stand at a time."""
    curve = moving(Fraction(x), Fraction(0), time, order, blur)
    return replace(curve, start=0 if curve.legs else -1)


def moving(x: Fraction, square2: Fraction, time: int, order: Order, blur: float = 0.0) -> Curve:
    """The curve from a place and a speed, whose doubled square is given."""
    return finished(tuple(lay(x, square2, time, order)), x, time, order.end, blur)
