"""All ways in which an axis may have moved so far, as its pulses show.

Where the contract leaves the unit a choice, a curve becomes a family of curves; what does not agree
with the pulses is dropped, and when nothing is left the unit has broken the contract.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from pos_change import CHANGE, begun, changed
from pos_curve import BITS, Curve, Order
from pos_family import TOLERANCE, Family, Observed, alone, parted, rest_ticks, tolerance
from pos_loose import resting
from pos_ways import Ways
from pos_words import Mismatch, Unsure

FAMILIES_MAX = 1500
WORK_MAX = 40_000
"""Curves of an axis that are compared in a session, each as often as it is."""


@dataclass
class Train:
    """The pulses of an axis: ticks, and +1 or -1 for each."""

    ticks: list[int] = field(default_factory=list)
    signs: list[int] = field(default_factory=list)
    work: int = 0
    """How many curves have been compared with it."""
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
        self._keep(begun(self.families, order, low, high))

    def change(self, tick: int, order: Order, late: int = CHANGE, *, anew: bool = True) -> None:
        """Something is wanted from a tick on, or a little later; not `anew`: it was so before."""
        self.verify(tick)
        first = self.offset + self.seen
        ahead = self.train.array[first : self.train.count_until(tick + late)]
        as_before = [] if anew else [replace(family, kept={}) for family in self.families]
        self._keep(changed(self.families, self.seen, (tick, late), order, ahead) + as_before)

    def _keep(self, families: list[Family]) -> None:
        self._work(len(families))
        rng = self.train.growing
        if rng:
            family = rng.choice(families)
            curve = family.curve(rng.randint(family.low, family.high))
            families = [alone(curve)]
        if len(families) > FAMILIES_MAX:
            raise Unsure("too many curves to follow")
        self.families = families

    # --- what there is to see ---

    def verify(self, until: int, *, goes_on: bool = False) -> None:
        """Compare the pulses up to a tick; if it goes on, those back come after a stand."""
        if not self.families:
            self._nothing(until)
            return
        if self.train.growing:
            self._grow(until)
        ticks = self.train.array[self.offset + self.seen : self.train.count_until(until)]
        if goes_on:
            ticks = self._same_way(ticks)
        if len(ticks):
            self.families = [
                f for family in self.families for f in family.seen(self.seen + 1, ticks)
            ]
        self._work(len(self.families))
        wrong = [family.narrow(self.seen + 1, ticks, until) for family in self.families]
        kept = [f for f, error in zip(self.families, wrong, strict=True) if error is None]
        if not kept:
            raise self._mismatch(ticks, until)
        signs = self.train.signs[self.offset + self.seen : self.offset + self.seen + len(ticks)]
        if any(sign != self.sign for sign in signs):
            raise Mismatch(int(ticks[0]), "a pulse in the wrong direction")
        self.families, self.seen = kept, self.seen + len(ticks)

    def _same_way(self, ticks: Observed) -> Observed:
        """The pulses before the first one the other way, by which the axis has stood."""
        first = self.offset + self.seen
        signs = self.train.signs[first : first + len(ticks)]
        same = next((i for i, sign in enumerate(signs) if sign != self.sign), len(ticks))
        if same < len(ticks):
            self.families, _ = self._resting(int(ticks[same]))
        return ticks[:same]

    def _work(self, curves: int) -> None:
        """Count what has to be followed: all ways together."""
        self.train.work += curves
        if self.train.work > WORK_MAX:
            raise Unsure("too much to follow")

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
                number, best = self.seen + 1 + at, min(errors, default=math.inf)
                return Mismatch(int(ticks[at]), f"pulse {number} is beside its time by {best:.2f}")
        return Mismatch(until, f"pulse {self.seen + len(ticks) + 1} does not come")

    def curves(self) -> list[Curve]:
        """The first and the last curve of every family."""
        return [curve for family in self.families for curve in family.both]

    def stand(self) -> tuple[float, float]:
        """When the axis stands at the earliest and the latest."""
        times = [rest_ticks(curve) for curve in self.curves()]
        return min(times), max(times)

    @property
    def blur_ticks(self) -> float:
        """By how many ticks more than any other its last pulse may be beside the stand."""
        lasts = [curve for curve in self.curves() if 0 < curve.count >= curve.next]
        return max((tolerance(c, c.count, c.count)[0] - TOLERANCE for c in lasts), default=0.0)

    # --- what is open ---

    def every(self, ways: Ways, holds: Callable[[Curve], bool]) -> bool:
        """Whether something holds for all curves; if for some, one of two ways is gone."""
        parts = [part for family in self.families for part in parted(family, holds)]
        answers = {holds(part.both[0]) for part in parts}
        answer = answers == {True} if len(answers) == 1 else not ways.choose()
        self.families = [part for part in parts if holds(part.both[0]) == answer]
        return answer

    def rests_early(self, ways: Ways, far: int) -> None:
        """Some stand long before others: one or the other way is gone."""
        before = self.stand()
        early, late = self._resting(before[0] + far)
        if early and late:
            self.families = late if ways.choose() else early
        if self.stand() == before:
            raise Unsure("an axis that may stand long before another pulse, or after it")

    def stood(self, ways: Ways, tick: int, unseen: int) -> bool:
        """Whether it stands at a tick, and the unit, which may be late, has seen it."""
        _, late = self._resting(tick - unseen)
        if late and not ways.choose():
            self.families = late
            return False
        self.families, _ = self._resting(tick)
        if not self.families:
            raise Mismatch(tick, "the axis cannot stand yet")
        return True

    def _resting(self, tick: float) -> tuple[list[Family], list[Family]]:
        """Those that rest at a tick, and those that come to rest later."""
        parts = [resting(family, tick) for family in self.families]
        return [f for early, _ in parts for f in early], [f for _, late in parts for f in late]

    def may_wait(self, tick: int) -> bool:
        """Whether it may not have left the stand at a tick."""
        return any(family.starts and tick <= family.high for family in self.families)

    def waits(self, ways: Ways, tick: int) -> bool:
        """Whether it has not left the stand."""
        moving = [
            family if family.high < tick else replace(family, high=tick - 1, kept={})
            for family in self.families
            if not family.starts or family.low < tick
        ]
        if moving and not ways.choose():
            self.families = moving
            return False
        return True
