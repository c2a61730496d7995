"""Follows the pulses of one move along the exact reference, through stops and changes of speed."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Sequence

from language_signals import Difference
from reference import FRACTION_BITS, Curve

ALL_PULSES = 400
"""Of a longer stretch not every pulse is compared, but its ends and some between."""

NEAR_ENDS = 60
REACTION_TICKS = 2
"""On the simulator a stop or a change acts at the very next pulse, give or take their rounding."""

TICK = 1 << FRACTION_BITS


class Follower:
    """One move: its start, its curve, and the pulses that were really made.

    `pulses` are the ticks of all pulses of the motor, `first` is the index of the move's first.
    Where it is open at which pulse a stop or a change acts there are several curves, and those that
    the pulses contradict are dropped.
    """

    def __init__(self, start: int, curve: Curve, pulses: Sequence[int], first: int) -> None:
        self.start = start
        self.made = 0
        self._curves = [curve]
        self._pulses = pulses
        self._first = first

    @property
    def curve(self) -> Curve:
        """The likeliest curve."""
        return self._curves[0]

    @property
    def end(self) -> int | None:
        """The tick of the last pulse, None for a run without end."""
        last = self.curve.last
        return None if last is None else self.start + self.curve.nearest_ticks([last])[0]

    def settle(self, made: int) -> None:
        """The move was made with so many pulses: prefer curves that have them."""
        self._curves.sort(key=lambda curve: curve.last != made)

    def tick_of(self, pulse: int) -> int:
        """The tick at which a pulse of the move was made; 0 is the start."""
        return self._pulses[self._first + pulse - 1] if pulse else self.start

    def follow(self, until: int) -> None:
        """Compare what was made before a tick, and that no pulse is missing."""
        made = bisect_left(self._pulses, until, lo=self._first) - self._first
        wrong = ""
        for curve in list(self._curves):
            complaint = self._compare(curve, made, until)
            if complaint:
                wrong = wrong or complaint
                self._curves.remove(curve)
        if not self._curves:
            raise Difference(f"the move at {self.start}: {wrong}")
        self.made = made

    def change(self, tick: int, new: Callable[[Curve, int], Curve]) -> None:
        """Something comes at a tick, after a pulse of that tick: `new` makes curves of it."""
        self.follow(tick)
        curves: dict[Curve, None] = {}
        for curve in self._curves:
            last = curve.pulses_before(tick - self.start + REACTION_TICKS) + 1
            last = last if curve.last is None else min(last, curve.last)
            for pulse in range(self.made + 1, last + 1):
                curves.setdefault(new(curve, pulse), None)
        self._curves = list(curves) or self._curves

    def _compare(self, curve: Curve, made: int, until: int) -> str:
        if curve.last is not None and made > curve.last:
            return f"{made} pulses instead of {curve.last}"
        for pulse in _sample(self.made + 1, made):
            error = (self.tick_of(pulse) - self.start << FRACTION_BITS) - curve.tick_scaled(pulse)
            if abs(error) > TICK:
                return f"pulse {pulse} is {error / TICK:.2f} ticks from its time"
        if made != curve.last and self.start + curve.nearest_ticks([made + 1])[0] < until - 1:
            return f"pulse {made + 1} did not come before {until}"
        return ""


def _sample(first: int, last: int) -> Sequence[int]:
    if last - first < ALL_PULSES:
        return range(first, last + 1)
    some = range(first + NEAR_ENDS, last - NEAR_ENDS, 1 + (last - first) // ALL_PULSES)
    near = (*range(first, first + NEAR_ENDS), *range(last - NEAR_ENDS, last + 1))
    return sorted({*near, *some})
