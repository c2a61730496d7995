"""Curves that differ in one instant that the contract leaves open, narrowed down by the pulses."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from pos_curve import BITS, GAIN, SLOWEST, Curve, Ticks
from pos_words import ACCEL_UNITS
from reference import TICK_HZ

TOLERANCE = 1.0 + 2**-6
"""Ticks; the little is for floats, and for the ends of families."""

CLOSE = 2**-7
"""So well are these found."""

CLOSE_TICKS = 2.0
SPREAD = 8
FEW = 6
"""So many curves of a family are followed each by itself."""

SAMPLES = 10
"""Of a family that is nearly one curve."""

SAMPLED = 0.25
"""Ticks more for a curve that stands for those beside it."""

Observed = NDArray[np.int64]


@dataclass
class Family:
    """The curves `make(low)` to `make(high)`.

    All pulses of one come later than those of the one before, or all earlier, or they are the same:
    who changes later is ahead or behind from then on.
    """

    make: Callable[[int], Curve]
    low: int = 0
    high: int = 0
    base: Curve | None = None
    """Without the change; None: it cannot be undone."""
    starts: bool = False
    """The instant is a start tick."""
    skip: int = 0
    """Pulses up to this one came before it, and have been compared."""
    error: float = 0.0
    """By how many ticks more than allowed pulses may be beside a curve."""
    kept: dict[int, Curve] = field(default_factory=dict)

    def curve(self, number: int) -> Curve:
        """One of them."""
        if number not in self.kept:
            self.kept[number] = self.make(number)
        return self.kept[number]

    @property
    def both(self) -> tuple[Curve, ...]:
        """The first and the last."""
        if self.low == self.high:
            return (self.curve(self.low),)
        return self.curve(self.low), self.curve(self.high)

    @property
    def spread(self) -> list[Curve]:
        """Some of them, from the first to the last."""
        count = min(SPREAD, self.high - self.low)
        numbers = [self.low + (self.high - self.low) * i // max(1, count) for i in range(count + 1)]
        return [self.make(number) for number in numbers]

    @property
    def wide(self) -> bool:
        """Whether there are too many to follow each."""
        return self.high - self.low >= FEW

    def closed(self, tick: int) -> list[Curve]:
        """Those that are followed each by itself from a tick on."""
        gaps, width = max(1, self.high - self.low), 0.0
        if self.wide:
            first, last = self.both
            width = apart(first, last, tick << BITS)
            gaps = min(SAMPLES, int(width / resolution(first, tick)))
        parts = max(1, gaps)
        numbers = {self.low + (self.high - self.low) * i // parts for i in range(gaps + 1)}
        return [
            replace(
                curve, blur=curve.blur + width / parts, blur_ticks=max(curve.blur_ticks, self.error)
            )
            for curve in map(self.curve, sorted(numbers))
        ]

    def shapes(self) -> tuple[int, int, Callable[[int], Curve]]:
        """The numbers of the curves, and what makes them."""
        return self.low, self.high, self.curve

    def within(self, low: int, high: int) -> Family:
        """The curves from one number to another."""
        return replace(self, low=low, high=high, kept={})

    def seen(self, number: int, ticks: Observed) -> list[Family]:
        """What comes of it when the next pulses, from this number on, are seen."""
        return [self]

    def narrow(self, first: int, ticks: Observed, until: int) -> float | None:
        """Keep those that agree with the pulses from number `first` on; no more came by `until`.

        Returns by how many ticks the best one is wrong, if none agrees.
        """
        done = max(0, self.skip + 1 - first)
        if done > len(ticks):
            return None
        first, ticks = first + done, ticks[done:]
        lows = self._errors(self.low, first, ticks, until)
        if self.low == self.high:
            return max(lows) if max(lows) > 0 else None
        highs = self._errors(self.high, first, ticks, until)
        if max(*lows, *highs) <= 0:
            return None
        falls = 0 if lows[0] > 0 or (lows[1] <= 0 and highs[1] > 0) else 1
        if lows[falls] > 0 and highs[falls] > 0:
            return min(max(lows), max(highs))

        def error(number: int, which: int) -> float:
            return self._errors(number, first, ticks, until, keep=False)[which]

        ends = self.low, self.high
        if lows[falls] > 0:
            self.low = crossing(lambda n: error(n, falls), ends, (lows[falls], highs[falls]))
        lows = self._errors(self.low, first, ticks, until)
        if max(lows) > 0:
            return max(lows)
        rises = 1 - falls
        if highs[rises] > 0:
            ends, errors = (-self.high, -self.low), (highs[rises], lows[rises])
            self.high = -crossing(lambda n: error(-n, rises), ends, errors)
        self.kept = {i: self.curve(i) for i in (self.low, self.high)}
        return None

    def _errors(
        self, number: int, first: int, ticks: Observed, until: int, *, keep: bool = True
    ) -> tuple[float, float]:
        """By how many ticks pulses came too late and too early, beyond what is allowed."""
        curve = self.curve(number) if keep else self.kept.get(number) or self.make(number)
        base = int(ticks[0]) if len(ticks) else until
        last = first + len(ticks) - 1
        due = curve.ticks(first, last + 1, base)
        seen = ticks - base
        allowed = tolerance(curve, first, last + 1) + self.error
        late = np.append(seen, until - base) - due - allowed
        early = due[:-1] - seen - allowed[:-1]
        return float(np.max(late)), float(np.max(early, initial=-np.inf))


def crossing(
    value: Callable[[int], float], ends: tuple[int, int], values: tuple[float, float]
) -> int:
    """The first number for which a falling value is not over 0, or one for which it nearly is 0.

    It is over 0 for the first number and not for the last one.
    """
    (low, high), (above, below) = ends, values
    halve = False
    while high - low > 1:
        mid = (low + high) // 2
        if not halve and math.isfinite(above - below):
            mid = low + int((high - low) * (above / (above - below)))
        mid = min(max(mid, low + 1), high - 1)
        there = value(mid)
        if -CLOSE <= there <= 0:
            return mid
        halve = not halve
        if there > 0:
            low, above = mid, there
        else:
            high, below = mid, there
    return high


def apart(curve: Curve, other: Curve, time: int) -> float:
    """By how many steps two curves differ at most from a time on, to their ends.

    The leg that they are on counts as a whole: near a rest all places are the same. A speed counts
    as the way on which the ramp makes up for it, as far as another change may bring them apart.
    """
    legs = [leg for each in (curve, other) for leg in each.legs if leg.end_time >= time]
    times = {time, *(leg.end_time for leg in legs), *(leg.time for leg in legs)}
    ways = (curve.place_at(each) - other.place_at(each) for each in times)
    return max(float(max(map(abs, ways))), _speed_apart(curve, other, time))


def _speed_apart(curve: Curve, other: Curve, time: int) -> float:
    place = curve.place_at(time)
    leg, beside = curve.leg_at(place), other.leg_at(place)
    if leg is None or beside is None:
        return 0.0
    squares = leg.square2_at(place) - beside.square2_at(place)
    return float(abs(squares) / (2 * GAIN * max(leg.accel, beside.accel)))


def resolution(curve: Curve, tick: int) -> float:
    """By how many steps curves may differ that pulses can hardly tell from each other."""
    times = [leg.time for leg in curve.legs if leg.end_time > tick << BITS]
    speeds = [curve.speed_after(max(time, tick << BITS)) for time in (tick << BITS, *times)]
    return CLOSE_TICKS * max(max(speeds), SLOWEST)


def tolerance(curve: Curve, first: int, last: int) -> Ticks:
    """By how many ticks each pulse may be beside the curve."""
    allowed = np.full(last - first + 1, TOLERANCE)
    if curve.blur or curve.blur_ticks:
        speeds = np.maximum(curve.speeds(first, last), SLOWEST)
        if curve.reaches and curve.legs and curve.legs[-1].sign < 0:
            # where the last ramp is does not depend on what was before it: only when
            ramp = np.arange(first, last + 1) > float(curve.legs[-1].x0)
            speeds[ramp] = np.maximum(speeds[ramp], curve.speed_after(curve.legs[-1].time))
        allowed += SAMPLED + np.minimum(curve.blur / speeds, _slowest(curve)) + curve.blur_ticks
    return allowed


def _slowest(curve: Curve) -> float:
    """How many ticks it takes at most to go so far as the curve may be wrong: where it stands."""
    accel = min((leg.accel for leg in curve.legs if leg.sign), default=0) / ACCEL_UNITS
    return math.sqrt(2 * curve.blur / accel) * TICK_HZ if accel else math.inf


def parted(family: Family, holds: Callable[[Curve], bool]) -> list[Family]:
    """The curves for which something holds, and the others: those of one end, and of the other."""
    low, high, curve = family.shapes()
    first = holds(curve(low))
    if holds(curve(high)) == first:
        return [family]
    below, above = low, high
    while above - below > 1:
        middle = (below + above) // 2
        below, above = (middle, above) if holds(curve(middle)) == first else (below, middle)
    return [family.within(low, below), family.within(above, high)]


def alone(curve: Curve) -> Family:
    """A curve that is sure."""
    return Family(lambda _: curve)


def rest_ticks(curve: Curve) -> float:
    """When a curve stands."""
    return curve.rest_time / (1 << BITS)
