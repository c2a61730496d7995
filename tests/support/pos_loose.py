"""Curves of which both the place and the time of a change are open, until a pulse is seen.

So it is where an axis leaves a rest that lies somewhere between two pulses, or where a change comes
before the first pulse after a start.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from exact import Fraction
from pos_curve import BITS, Curve
from pos_family import SPREAD, Family, Observed, crossing, parted, rest_ticks

BESIDE = (2 << BITS) // 3
"""A pulse may be a tick beside its time: three guesses, each right to a third of a tick."""

ERROR = 1 / 3


@dataclass
class Loose(Family):
    """The curves `shape(first)` to `shape(last)`, each from some tick on, `low` to `high`.

    A shape begins at the time 0; the places where they begin rise with the number.
    """

    shape: Callable[[int], Curve] = field(kw_only=True)
    first: int = 0
    last: int = 0

    @property
    def both(self) -> tuple[Curve, ...]:
        """The one that is furthest back, and the one that is furthest ahead."""
        behind = self.shape(self.first).shifted(self.high << BITS)
        return behind, self.shape(self.last).shifted(self.low << BITS)

    @property
    def spread(self) -> list[Curve]:
        """Some of them: from places all along, each from the first, middle and last tick."""
        count = min(SPREAD, self.last - self.first)
        numbers = (
            self.first + (self.last - self.first) * i // max(1, count) for i in range(count + 1)
        )
        ticks = sorted({self.low, (self.low + self.high) // 2, self.high})
        return [self.shape(number).shifted(tick << BITS) for number in numbers for tick in ticks]

    def shapes(self) -> tuple[int, int, Callable[[int], Curve]]:
        """The numbers of the places, and what leaves them."""
        return self.first, self.last, lambda n: self.shape(n).shifted(self.low << BITS)

    def within(self, low: int, high: int) -> Family:
        """Those from some of the places."""
        return replace(self, first=low, last=high, kept={})

    def narrow(self, first: int, ticks: Observed, until: int) -> float | None:
        """Without a pulse there is nothing to be told."""
        return None

    def seen(self, number: int, ticks: Observed) -> list[Family]:
        """The families of those places from which the pulse comes then, or a little beside."""
        families: list[Family] = []
        done = max(0, self.skip + 1 - number)
        if done >= len(ticks):
            return [self]
        number, tick = number + done, int(ticks[done])
        ends = self._reaching(number)
        if ends is None:
            return families
        for offset in (-1, 0, 1):
            family = self._within(self._from(number, (tick << BITS) + offset * BESIDE), ends)
            families += [family] if family else []
        return families

    def _reaching(self, number: int) -> tuple[int, int] | None:
        """The places from which a pulse is the first one."""

        def lacks(n: int) -> float:
            return math.inf if self.shape(n).count < number else -math.inf

        def has_passed(n: int) -> float:
            return math.inf if self.shape(-n).next > number else -math.inf

        low = since(lacks, self.first, self.last)
        high = since(has_passed, -self.last, -self.first)
        return None if low is None or high is None or low > -high else (low, -high)

    def _within(self, make: Callable[[int], Curve], ends: tuple[int, int]) -> Family | None:
        """Those that begin when they may."""
        low = since(lambda n: self.low - 2 - _begin(make(n)), *ends)
        high = since(lambda n: _begin(make(-n)) - self.high - 2, -ends[1], -ends[0])
        if low is None or high is None or low > -high:
            return None
        return Family(make, low, -high, skip=self.skip, error=ERROR)

    def _from(self, number: int, time: int) -> Callable[[int], Curve]:
        def make(n: int) -> Curve:
            curve = self.shape(n)
            return curve.shifted(time - curve.time_of(number))

        return make


def _place(curve: Curve) -> Fraction:
    return curve.legs[0].x0 if curve.legs else curve.rest


def _begin(curve: Curve) -> float:
    return curve.legs[0].time / (1 << BITS)


def since(value: Callable[[int], float], low: int, high: int) -> int | None:
    """The first number for which a falling value is not over 0; None: there is none."""
    above = value(low)
    if above <= 0:
        return low
    below = value(high)
    return None if below > 0 else crossing(value, (low, high), (above, below))


def loose(
    shape: Callable[[int], Curve], places: tuple[int, int], ticks: tuple[int, int], skip: int = 0
) -> Loose:
    """Curves from some places, which rise or fall with the number, at some ticks."""
    first, last = places
    if _place(shape(first)) > _place(shape(last)):
        return loose(lambda n: shape(first + last - n), places, ticks, skip)
    middle = shape((first + last) // 2)
    return Loose(
        lambda tick: middle.shifted(tick << BITS),
        *ticks,
        starts=True,
        shape=shape,
        first=first,
        last=last,
        skip=skip,
    )


def rested(family: Family, start: Callable[[Curve], Curve], ticks: tuple[int, int]) -> Loose:
    """Starts from the rests of a family whose rest is not known."""
    if isinstance(family, Loose):
        old, places = family.shape, (family.first, family.last)
    else:
        old, places = family.curve, (family.low, family.high)
    return loose(lambda n: start(old(n)), places, ticks, family.skip)


def resting(family: Family, tick: float) -> tuple[list[Family], list[Family]]:
    """The curves that rest at a tick, and those that come to rest later."""
    if not isinstance(family, Loose):
        parts = parted(family, lambda curve: rest_ticks(curve) <= tick)
        early = [part for part in parts if rest_ticks(part.both[0]) <= tick]
        return early, [part for part in parts if rest_ticks(part.both[0]) > tick]
    # where some of the places rest in time and others do not, the start tick is in both
    rests = [rest_ticks(family.shape(number)) for number in (family.first, family.last)]
    high, low = math.floor(tick - min(rests)), math.floor(tick - max(rests)) + 1
    before = replace(family, high=min(high, family.high), kept={})
    after = replace(family, low=max(low, family.low), kept={})
    return [f for f in [before] if f.low <= f.high], [f for f in [after] if f.low <= f.high]
