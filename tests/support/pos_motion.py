"""All ways in which an axis may have moved so far, as its pulses show.

Where the contract leaves the unit a choice, a curve becomes a family of curves; what does not agree
with the pulses is dropped, and when nothing is left the unit has broken the contract.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from pos_curve import BITS, GAIN, Curve, Leg, Order, started
from pos_family import Family, alone, rest_ticks, rested
from pos_words import MS, SPEED_UNITS, Mismatch, Unsure

CHANGE = MS
"""A change takes effect within this, or at the next pulse."""

SLOW_CHANGE = 20 * MS
"""Likewise below 1 step/s."""

FAMILIES_MAX = 64
NEVER = 2**62


@dataclass
class Train:
    """The pulses of an axis: ticks, and +1 or -1 for each."""

    ticks: list[int] = field(default_factory=list)
    signs: list[int] = field(default_factory=list)
    growing: random.Random | None = None
    """The model makes the pulses itself, and draws what is open from this."""

    def count_until(self, tick: float) -> int:
        """The pulses up to a tick."""
        return int(np.searchsorted(self.array, tick, side="right"))

    @property
    def array(self) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
        """The ticks, to compute with."""
        if len(self._array) != len(self.ticks):
            self._array = np.array(self.ticks, dtype=np.int64)
        return self._array

    _array: np.ndarray[tuple[int], np.dtype[np.int64]] = field(
        default_factory=lambda: np.zeros(0, dtype=np.int64)
    )


def ceil_tick(time: int) -> int:
    """The first tick at or after a time."""
    return -(-time >> BITS)


class Motion:
    """The curves of one measure that agree with the pulses."""

    def __init__(self, train: Train) -> None:
        """The axis stands."""
        self.train = train
        self.families: list[Family] = []
        self.offset = 0
        self.seen = 0
        """Pulses of the measure."""
        self.sign = 1

    @property
    def moving(self) -> bool:
        """Whether it has been set in motion and has not been said to stand."""
        return bool(self.families)

    # --- what the unit does ---

    def prepare(self, sign: int) -> None:
        """A measure begins where the axis stands."""
        self.families, self.offset, self.seen = [], self.offset + self.seen, 0
        self.sign = sign

    def begin(self, order: Order, low: int, high: int) -> None:
        """Leave the stand at a tick within a window, from where each curve rests."""
        open_ones = [f for f in self.families if f.wide and not f.starts]
        sure = [f for f in self.families if f not in open_ones]
        rests: list[Curve | None] = [curve for family in sure for curve in family.closed(low)]
        families: dict[Fraction, Family] = {}
        for curve in rests or ([] if open_ones else [None]):
            x = curve.rest if curve else Fraction(0)
            first = max(low, ceil_tick(curve.rest_time)) if curve else low
            blur = curve.blur if curve else 0.0
            if x not in families or first < families[x].low:
                families[x] = _start(x, order, first, max(high, first + high - low), blur)
        self._keep([*families.values(), *(rested(f, order, low, high) for f in open_ones)])

    def change(self, tick: int, order: Order, late: int = CHANGE) -> None:
        """Something else is wanted from a tick on, or a little later."""
        self.verify(tick)
        families: list[Family] = []
        for family in self.families:
            families += self._changed(family, tick, order, late)
        self._keep(families)

    def _changed(self, family: Family, tick: int, order: Order, late: int) -> Iterator[Family]:
        sources = [family.base] if family.base and self._undone(family, tick) else []
        if family.wide:
            both = [list(self._places(curve, tick, late)) for curve in family.both]
            if both[0] == both[1] and len(both[0]) == 1 and len(set(both[0][0][1:])) == 1:
                yield self._composed(family, order, *both[0][0][:2])
                sources = [] if family.starts else sources
            elif family.starts:
                raise Unsure("a change before a start has shown itself")
            else:
                sources += family.closed(tick)
        else:
            sources += family.closed(tick)
        for curve in sources:
            yield from self._of_curve(curve, tick, order, late)

    def _undone(self, family: Family, tick: int) -> bool:
        """Whether what made a family may not have come to pass before a tick."""
        low, high = family.both[0], family.both[-1]
        assert family.base is not None
        return any(
            curve.legs != family.base.legs and _parting(curve, family.base) >= tick << BITS
            for curve in (low, high)
        )

    def _composed(self, family: Family, order: Order, per_step: int, number: int) -> Family:
        place = Fraction(number, per_step)
        make = family.make
        return Family(
            lambda i: make(i).changed(place, order),
            family.low,
            family.high,
            starts=family.starts,
        )

    def _of_curve(self, curve: Curve, tick: int, order: Order, late: int) -> Iterator[Family]:
        options = list(self._places(curve, tick, late))
        for per_step, low, high in options:
            yield self._family(curve, order, per_step, low, high)
        rests = ceil_tick(curve.rest_time)
        if options and rests > tick + late:
            return
        if curve.reaches or not order.speed:
            yield alone(curve)
        else:
            first = max(tick, rests)
            yield _start(curve.rest, order, first, first + 2 * CHANGE, curve.blur, before=curve)

    def _family(self, curve: Curve, order: Order, per_step: int, low: int, high: int) -> Family:
        family = Family(
            lambda i: curve.changed(Fraction(i, per_step), order), low, high, base=curve
        )
        first, last = family.both[0], family.both[-1]
        return alone(curve) if first.legs == last.legs == curve.legs else family

    def _places(self, curve: Curve, tick: int, late: int) -> Iterator[tuple[int, int, int]]:
        """Where a change may take effect: places in a step, first and last."""
        first = self.seen + 1
        if curve.rest_time <= tick << BITS or first > curve.count:
            due = NEVER
        else:
            due = ceil_tick(curve.time_of(first))
            last = first
            while last < curve.count and curve.time_of(last + 1) <= tick + late << BITS:
                last += 1
        between = list(_between(curve, tick, late, due)) if due > tick + late else []
        cruises = between and _leg_during(curve, tick).sign == 0
        if due < NEVER and (not cruises or due <= tick + 2 * late):
            yield 1, first, last
        yield from between

    def _keep(self, families: list[Family]) -> None:
        rng = self.train.growing
        if rng:
            family = rng.choice(families)
            curve = family.curve(rng.randint(family.low, family.high))
            families = [alone(curve)]
        if len(families) > FAMILIES_MAX:
            raise Unsure("too many curves to follow")
        self.families = families

    # --- what there is to see ---

    def verify(self, until: int) -> None:
        """Compare the pulses up to a tick."""
        if not self.families:
            self._nothing(until)
            return
        if self.train.growing:
            self._grow(until)
        ticks = self.train.array[self.offset + self.seen : self.train.count_until(until)]
        if len(ticks):
            self.families = [f for family in self.families for f in family.seen(int(ticks[0]))]
        wrong = [family.narrow(self.seen + 1, ticks, until) for family in self.families]
        kept = [f for f, error in zip(self.families, wrong, strict=True) if error is None]
        if not kept:
            raise self._mismatch(ticks, until)
        signs = self.train.signs[self.offset + self.seen : self.offset + self.seen + len(ticks)]
        if any(sign != self.sign for sign in signs):
            raise Mismatch(int(ticks[0]), "a pulse in the wrong direction")
        self.families, self.seen = kept, self.seen + len(ticks)

    def _nothing(self, until: int) -> None:
        extra = self.train.count_until(until) - self.offset - self.seen
        if extra > 0:
            raise Mismatch(self.train.ticks[self.offset + self.seen], "a pulse of an axis at rest")

    def _grow(self, until: int) -> None:
        curve = self.families[0].curve(self.families[0].low)
        for number in range(self.seen + 1, curve.count + 1):
            tick = (curve.time_of(number) + (1 << BITS - 1)) >> BITS
            if tick > until:
                break
            if len(self.train.ticks) < self.offset + number:
                self.train.ticks.append(tick)
                self.train.signs.append(self.sign)

    def _mismatch(self, ticks: np.ndarray[tuple[int], np.dtype[np.int64]], until: int) -> Mismatch:
        for at in range(len(ticks)):
            wrong = [f.narrow(self.seen + 1, ticks[: at + 1], 0) for f in self.families]
            errors = [error for error in wrong if error is not None]
            if len(errors) == len(wrong):
                number, best = self.seen + 1 + at, min(errors)
                return Mismatch(int(ticks[at]), f"pulse {number} is beside its time by {best:.2f}")
        return Mismatch(until, f"pulse {self.seen + len(ticks) + 1} does not come")

    def curves(self) -> list[Curve]:
        """The first and the last curve of every family."""
        return [curve for family in self.families for curve in family.both]

    def stand(self) -> tuple[float, float]:
        """When the axis stands at the earliest and the latest."""
        times = [rest_ticks(curve) for curve in self.curves()]
        return min(times), max(times)

    def every(self, holds: Callable[[Curve], bool], what: str) -> bool:
        """Whether something holds for all curves, or for none."""
        answers = {holds(curve) for curve in self.curves()}
        if len(answers) > 1:
            raise Unsure(what)
        return answers == {True}


def _start(
    x: Fraction, order: Order, low: int, high: int, blur: float, before: Curve | None = None
) -> Family:
    return Family(
        lambda tick: _after(before, started(x, tick << BITS, order, blur)), low, high, starts=True
    )


def _after(before: Curve | None, curve: Curve) -> Curve:
    """A curve with what came before its stand."""
    if before is None:
        return curve
    legs = (*before.legs, *curve.legs)
    return Curve(legs, curve.rest, curve.rest_time, curve.end, curve.blur)


def _leg_during(curve: Curve, tick: int) -> Leg:
    """The leg at a tick; the first one, if none has begun."""
    begun = [leg for leg in curve.legs if leg.time <= tick << BITS]
    return begun[-1] if begun else curve.legs[0]


def _between(curve: Curve, tick: int, late: int, due: int) -> Iterator[tuple[int, int, int]]:
    """Places between pulses where a change may take effect at constant speed."""
    for leg in curve.legs:
        slow = leg.square2 < 2 * SPEED_UNITS**2
        window = SLOW_CHANGE if slow and late == CHANGE else late
        low = max(tick << BITS, leg.time)
        high = min(min(due, tick + window) << BITS, leg.end_time)
        if leg.sign or low >= high:
            continue
        per_step = GAIN * leg.accel
        first = math.ceil(leg.place_at(low) * per_step)
        last = math.floor(leg.place_at(high) * per_step)
        if first <= last:
            yield per_step, max(first, math.floor(leg.x0 * per_step) + 1), last


def _parting(curve: Curve, other: Curve) -> int:
    """When two curves part."""
    for a, b in zip(curve.legs, other.legs, strict=False):
        if a != b:
            return min(a.end_time, b.end_time) if a.time == b.time else max(a.time, b.time)
    return min(curve.rest_time, other.rest_time)
