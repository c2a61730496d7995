"""Curves that differ in one instant that the contract leaves open, narrowed down by the pulses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from pos_curve import BITS, Curve, Order, Ticks, started
from reference import TICK_HZ

TOLERANCE = 1.0 + 2**-10
"""Ticks; the little is for floats."""

SAME = 2**-10
FEW = 6
"""So many curves of a family are followed each by itself."""

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
    def wide(self) -> bool:
        """Whether there are too many to follow each."""
        return self.high - self.low >= FEW

    def closed(self, tick: int) -> list[Curve]:
        """Those that are followed each by itself from a tick on."""
        if not self.wide:
            return [self.curve(number) for number in range(self.low, self.high + 1)]
        gaps = FEW - 1
        numbers = {self.low + (self.high - self.low) * i // gaps for i in range(FEW)}
        blur = apart(self.curve(self.low), self.curve(self.high), tick << BITS) / gaps
        return [replace(c, blur=c.blur + blur) for c in map(self.curve, sorted(numbers))]

    def seen(self, tick: int) -> list[Family]:
        """What comes of it when the next pulse is seen at a tick."""
        return [self]

    def narrow(self, first: int, ticks: Observed, until: int) -> float | None:
        """Keep those that agree with the pulses from number `first` on; no more came by `until`.

        Returns by how many ticks the best one is wrong, if none agrees.
        """
        lows = self._errors(self.low, first, ticks, until)
        if self.low == self.high:
            return max(lows) if max(lows) > 0 else None
        highs = self._errors(self.high, first, ticks, until)
        if max(*lows, *highs) <= 0:
            return None
        falls = 0 if lows[0] > 0 or (lows[1] <= 0 and highs[1] > 0) else 1
        if lows[falls] > 0 and highs[falls] > 0:
            return min(max(lows), max(highs))
        if lows[falls] > 0:
            self.low = self._bisect(falls, first, ticks, until, rising=False)
        lows = self._errors(self.low, first, ticks, until)
        if max(lows) > 0:
            return max(lows)
        if highs[1 - falls] > 0:
            self.high = self._bisect(1 - falls, first, ticks, until, rising=True)
        self.kept = {i: self.curve(i) for i in (self.low, self.high)}
        return None

    def _bisect(self, which: int, first: int, ticks: Observed, until: int, *, rising: bool) -> int:
        """The first curve without an error (that falls), or the last one (of one that rises)."""
        low, high = self.low, self.high
        while high - low > 1:
            mid = (low + high) // 2
            bad = self._errors(mid, first, ticks, until, keep=False)[which] > 0
            low, high = (mid, high) if bad != rising else (low, mid)
        return low if rising else high

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


class Rested(Family):
    """Starts from a rest that is not known well: from which place the first two pulses tell."""

    rests: Family
    order: Order

    def narrow(self, first: int, ticks: Observed, until: int) -> float | None:
        """Without a pulse there is nothing to be told."""
        return None

    def seen(self, tick: int) -> list[Family]:
        """The families of places from which the first pulse comes at a tick, or a little beside."""
        found = []
        for offset in (-1, 0, 1):
            time = (tick << BITS) + offset * BESIDE
            family = Family(self._from(time), self.rests.low, self.rests.high, error=1 / 3)
            family.low = self._first(family, self.low - 2)
            family.high = self._first(family, self.high + 2)
            if family.low <= family.high:
                found.append(family)
        return found

    def _from(self, time: int) -> Callable[[int], Curve]:
        order, rests = self.order, self.rests

        def make(number: int) -> Curve:
            rest = rests.curve(number)
            way = started(rest.rest, 0, order)
            return started(rest.rest, time - way.time_of(way.first), order, rest.blur)

        return make

    def _first(self, family: Family, tick: int) -> int:
        """The first place from which the start comes after a tick, or the last one."""
        low, high = self.rests.low, self.rests.high
        while low < high:
            mid = (low + high) // 2
            if family.make(mid).legs[0].time < tick << BITS:
                low = mid + 1
            else:
                high = mid
        return low


BESIDE = (2 << BITS) // 3
"""A first pulse may be a tick beside its time: three guesses, each a third of a tick off."""


def rested(rests: Family, order: Order, low: int, high: int) -> Rested:
    """Starts within a window from the places where a family rests."""
    middle = rests.curve((rests.low + rests.high) // 2)
    first = max(low, min(-(-curve.rest_time >> BITS) for curve in rests.both))
    family = Rested(
        lambda tick: started(middle.rest, tick << BITS, order, middle.blur),
        first,
        first + high - low,
        starts=True,
    )
    family.rests, family.order = rests, order
    return family


def apart(curve: Curve, other: Curve, time: int) -> float:
    """By how many steps two curves differ at most from a time on, to their ends."""
    times = {time, *(leg.end_time for each in (curve, other) for leg in each.legs)}
    ways = (curve.place_at(each) - other.place_at(each) for each in times if each >= time)
    return float(max(map(abs, ways)))


def tolerance(curve: Curve, first: int, last: int) -> Ticks:
    """By how many ticks each pulse may be beside the curve."""
    allowed = np.full(last - first + 1, TOLERANCE)
    if curve.blur:
        for number in range(first, min(last, curve.count) + 1):
            allowed[number - first] += curve.blur / max(curve.speed_at(number), 1 / TICK_HZ / 256)
    return allowed


def alone(curve: Curve) -> Family:
    """A curve that is sure."""
    return Family(lambda _: curve)


def rest_ticks(curve: Curve) -> float:
    """When a curve stands."""
    return curve.rest_time / (1 << BITS)
