"""The exact reference of the step times: what every pulse train is measured against.

In: sections of a move (steps, top speed in steps/s, acceleration in steps/s²) and the
start/stop speed. Out: the ideal tick of every pulse, as an exact number with
`FRACTION_BITS` binary places after the point.

The idea behind it: on a ramp the square of the speed is linear in the position,

    w(x) = v(x)² = w0 + 2·a·(x - x0),

so a move is a chain of legs (`Leg`) whose corners are rational numbers, however
irrational its speeds are. Only the time needs a root:

    t = (√w1 - √w0) / a   on a ramp,      t = (x1 - x0) / √w0   at constant speed,

and that root is taken in integers, with `ROOT_BITS` binary places. There is no float
in any of it. Each leg adds an error below 2^-63 tick.

Pulse k is due when the position reaches k for the first time; the move starts at
position 0 and tick 0 and ends with its last pulse.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate

from exact import Fraction

TICK_HZ = 84_000_000
"""Rate of the step timer, ticks per second."""

FRACTION_BITS = 64
"""Binary places of a tick after the point."""

ROOT_BITS = 128
"""Binary places of the speeds from which ticks are computed."""

ENDLESS = 1 << 60
"""Steps of a run without end: at the top speed it would last two million years."""

Position = int | Fraction


@dataclass(frozen=True)
class Section:
    """One section of a move: at most `speed` steps/s, changed with `accel` steps/s²."""

    steps: int
    speed: int
    accel: int

    def __post_init__(self) -> None:
        """Refuse what no move can have."""
        if min(self.steps, self.speed, self.accel) < 1:
            raise ValueError(f"steps, speed and acceleration start at 1: {self}")


@dataclass(frozen=True)
class Leg:
    """Motion from position x0 to x1 with w(x) = w0 + 2·a·(x - x0), w in (steps/s)².

    `a` is the signed acceleration in steps/s², 0 for constant speed.
    """

    x0: Fraction
    x1: Fraction
    w0: Fraction
    a: int

    @cached_property
    def w1(self) -> Fraction:
        """Square of the speed at the end of the leg."""
        return self.speed_squared(self.x1)

    def speed_squared(self, x: Position) -> Fraction:
        """Square of the speed at position x, (steps/s)², exact."""
        return self.w0 + 2 * self.a * (x - self.x0)

    def elapsed(self, x: Position, tick_hz: int) -> int:
        """Time from x0 to x, in units of 2^-FRACTION_BITS tick."""
        way, scale = self._way(x)
        if self.a == 0:
            ticks = way * tick_hz << (FRACTION_BITS + ROOT_BITS)
            return ticks // (scale * self._root0)
        w, u = self.w0.numerator, self.w0.denominator
        gained = _root(w * scale + 2 * self.a * way * u, u * scale) - self._root0
        return (gained * tick_hz >> (ROOT_BITS - FRACTION_BITS)) // self.a

    def _way(self, x: Position) -> tuple[int, int]:
        """Way from x0 to x as numerator and denominator, not reduced."""
        n, d = x.numerator, x.denominator
        p, q = self.x0.numerator, self.x0.denominator
        return n * q - p * d, d * q

    @cached_property
    def _root0(self) -> int:
        """Speed at x0, scaled by 2^ROOT_BITS."""
        return _root(self.w0.numerator, self.w0.denominator)


@dataclass(frozen=True)
class Stretch:
    """What is left of a section: up to position `end`, with its speed and accel."""

    end: int
    speed: int
    accel: int

    @property
    def top(self) -> int:
        """Square of the greatest speed."""
        return self.speed**2


@dataclass(frozen=True)
class Curve:
    """The motion of one move, and what a stop or a speed change makes of it.

    `legs` join from position 0 on; from one leg to the next the speed may jump only
    where a speed change lets it. `sections` are those of the move with the speeds in
    force. `fixed` is set where no speed change acts: a limit run, a stopped move.
    """

    legs: tuple[Leg, ...]
    sections: tuple[Section, ...]
    start_speed: int
    tick_hz: int
    fixed: bool = False

    @cached_property
    def last(self) -> int | None:
        """Number of the last pulse, None for a run without end."""
        end = math.floor(self.legs[-1].x1)
        return None if end >= ENDLESS else end

    def tick_scaled(self, k: int) -> int:
        """Tick of pulse k since the start, in units of 2^-FRACTION_BITS tick."""
        self._require(k, first=0)
        leg = bisect_left(self._floors, k)
        return self._starts[leg] + self.legs[leg].elapsed(k, self.tick_hz)

    def tick(self, k: int) -> Fraction:
        """Tick of pulse k since the start of the move; pulse 0 stands for the start."""
        return Fraction(self.tick_scaled(k), 1 << FRACTION_BITS)

    def ticks(self, pulses: Iterable[int]) -> list[Fraction]:
        """Ticks of several pulses."""
        return [self.tick(k) for k in pulses]

    def nearest_ticks(self, pulses: Iterable[int]) -> list[int]:
        """Ticks of several pulses, rounded to the nearest whole tick."""
        half = 1 << (FRACTION_BITS - 1)
        return [(self.tick_scaled(k) + half) >> FRACTION_BITS for k in pulses]

    def pulses_before(self, tick: int | Fraction) -> int:
        """How many pulses are due before `tick`; the next pulse is one more."""
        limit = math.ceil(tick * (1 << FRACTION_BITS))
        end = ENDLESS if self.last is None else self.last
        return bisect_left(range(1, end + 1), limit, key=self.tick_scaled)

    def speed_squared(self, k: int) -> Fraction:
        """Square of the speed at pulse k, (steps/s)²; where it jumps, after the jump.

        At the last pulse it is the speed at which the motor arrives.
        """
        self._require(k, first=0)
        leg = min(bisect_right(self._ceilings, k), len(self.legs) - 1)
        return self.legs[leg].speed_squared(k)

    def corners(self) -> list[tuple[Fraction, float]]:
        """Return the break points: position and speed (steps/s, to float accuracy).

        A jump of the speed is two corners at one position. The last corner is the
        end of the curve, which for a stopped move may lie after its last pulse.
        """
        points = []
        for leg in self.legs:
            points += [(leg.x0, leg.w0), (leg.x1, leg.w1)]
        unique = dict.fromkeys(point for point in points if point[0] < ENDLESS // 2)
        return [(x, math.sqrt(w)) for x, w in unique]

    def stopped_at(self, k: int) -> Curve:
        """Return the curve when a stop takes effect at pulse k, which is still made.

        Above the start/stop speed S the motor brakes to S, with the acceleration of
        each section it comes through; the last pulse is the last one on that way. At
        S or below no pulse follows.
        """
        self._require(k, first=1)
        w = self.speed_squared(k)
        brake = _brake(k, w, _stretches(self.sections, k), self.start_speed**2)
        return replace(self, legs=_join([*self._cut(k), *brake]), fixed=True)

    def speed_changed_at(self, k: int, speed: int) -> Curve:
        """Return the curve when `speed` replaces the current section's at pulse k.

        A pulse on a border changes the section that begins there. Speeds up to S are
        taken at once, above S the speed changes with the section's acceleration.
        Everything after pulse k is looked ahead again.
        """
        self._require(k, first=1)
        if self.fixed or k == self.last:
            return self
        sections = _with_speed(self.sections, k, speed)
        stretches = _stretches(sections, k)
        w = _taken_at_once(k, self.speed_squared(k), stretches, self.start_speed)
        tail = _lay(k, w, stretches, self.start_speed)
        return replace(self, legs=_join([*self._cut(k), *tail]), sections=sections)

    def _require(self, k: int, first: int) -> None:
        if k < first or k > (ENDLESS if self.last is None else self.last):
            raise ValueError(f"no pulse {k} in a move whose last pulse is {self.last}")

    def _cut(self, k: int) -> list[Leg]:
        """Return the legs up to position k."""
        kept = [leg for leg in self.legs if leg.x0 < k]
        return [*kept[:-1], replace(kept[-1], x1=min(kept[-1].x1, Fraction(k)))]

    @cached_property
    def _starts(self) -> list[int]:
        """Tick at which each leg starts, in units of 2^-FRACTION_BITS tick."""
        times = (leg.elapsed(leg.x1, self.tick_hz) for leg in self.legs[:-1])
        return list(accumulate(times, initial=0))

    @cached_property
    def _floors(self) -> list[int]:
        return [math.floor(leg.x1) for leg in self.legs]

    @cached_property
    def _ceilings(self) -> list[int]:
        return [math.ceil(leg.x1) for leg in self.legs]


def plan(sections: Sequence[Section], start_speed: int, tick_hz: int = TICK_HZ) -> Curve:
    """Return the curve of a move: one section for a single one, more for a compound.

    It starts at min(S, V1), ends at min(S, Vm), and the border speeds between are as
    high as the speeds on both sides and the way to the neighbouring borders allow. A
    short way lowers the first speed too, when a border after it is slower than S,
    and the last one, when the way up to S is too short.
    """
    if start_speed < 1 or not sections:
        raise ValueError("a move has a section and a start/stop speed of at least 1")
    stretches = _stretches(sections, 0)
    w = _taken_at_once(0, Fraction(0), stretches, start_speed)
    legs = _lay(0, w, stretches, start_speed)
    return Curve(_join(legs), tuple(sections), start_speed, tick_hz)


def single(steps: int, start_speed: int, speed: int, accel: int, tick_hz: int = TICK_HZ) -> Curve:
    """Return the curve of a single move."""
    return plan([Section(steps, speed, accel)], start_speed, tick_hz)


def endless(start_speed: int, speed: int, accel: int, tick_hz: int = TICK_HZ) -> Curve:
    """Return the curve of a run without end: S to V, then V until it is stopped."""
    return single(ENDLESS, start_speed, speed, accel, tick_hz)


def limit_run(start_speed: int, tick_hz: int = TICK_HZ) -> Curve:
    """Return the curve of a limit run: constant S until it is stopped, at once."""
    run = single(ENDLESS, start_speed, start_speed, 1, tick_hz)
    return replace(run, fixed=True)


def _root(numerator: int, denominator: int) -> int:
    """√(numerator/denominator), scaled by 2^ROOT_BITS, rounded down."""
    return math.isqrt((numerator << 2 * ROOT_BITS) // denominator)


def _stretches(sections: Sequence[Section], x: int) -> list[Stretch]:
    """Return what is left of the sections after position x."""
    ends = accumulate(section.steps for section in sections)
    return [
        Stretch(end, section.speed, section.accel)
        for end, section in zip(ends, sections, strict=True)
        if end > x
    ]


def _with_speed(sections: tuple[Section, ...], x: int, speed: int) -> tuple[Section, ...]:
    """Replace the speed of the section in which the way after position x lies."""
    ends = list(accumulate(section.steps for section in sections))
    i = bisect_right(ends, x)
    return (*sections[:i], replace(sections[i], speed=speed), *sections[i + 1 :])


def _bounds(stretches: Sequence[Stretch], start_speed: int) -> list[int]:
    """Look ahead: the greatest w at the end of each stretch.

    The move ends at min(S, Vm). Before that, w is at most that of the slower
    neighbour, and at most what the next stretch can brake down to its own bound.
    """
    bound = min(start_speed, stretches[-1].speed) ** 2
    bounds = [bound]
    for stretch, after in zip(stretches[-2::-1], stretches[:0:-1], strict=True):
        way = after.end - stretch.end
        bound = min(stretch.top, after.top, bound + 2 * after.accel * way)
        bounds.append(bound)
    return bounds[::-1]


def _taken_at_once(x: int, w: Fraction, stretches: Sequence[Stretch], start_speed: int) -> Fraction:
    """Speed squared after a start or a speed change: speeds up to S need no ramp.

    Upward it jumps no higher than what can still be braked to the bound.
    """
    stretch, slow = stretches[0], start_speed**2
    bound = _bounds(stretches, start_speed)[0]
    brakeable = bound + 2 * stretch.accel * (stretch.end - x)
    step = min(slow, stretch.top)
    if w < step:
        return Fraction(min(step, brakeable))
    return Fraction(stretch.top) if stretch.top < w <= slow else w


def _lay(x: int, w: Fraction, stretches: Sequence[Stretch], start_speed: int) -> list[Leg]:
    """Lay the legs from position x, speed squared w, through all stretches."""
    legs: list[Leg] = []
    at, now = Fraction(x), w
    bounds = _bounds(stretches, start_speed)
    for stretch, bound in zip(stretches, bounds, strict=True):
        slowing, at, now = _slow_down(at, now, stretch, start_speed**2)
        trapezoid, now = _trapezoid(at, now, stretch, bound)
        legs += [*slowing, *trapezoid]
        at = Fraction(stretch.end)
    return legs


def _slow_down(
    x: Fraction, w: Fraction, stretch: Stretch, slow: int
) -> tuple[list[Leg], Fraction, Fraction]:
    """Brake to the stretch's speed when above it: legs, position and w after them.

    A speed below S is taken at once where S (`slow` = S²) is reached. Where the
    stretch ends before, so does the braking.
    """
    if w <= stretch.top:
        return [], x, w
    knee = x + (w - max(stretch.top, slow)) / (2 * stretch.accel)
    if knee > stretch.end:
        leg = Leg(x, Fraction(stretch.end), w, -stretch.accel)
        return [leg], leg.x1, leg.w1
    return [Leg(x, knee, w, -stretch.accel)], knee, Fraction(stretch.top)


def _trapezoid(
    x: Fraction, w: Fraction, stretch: Stretch, bound: int
) -> tuple[list[Leg], Fraction]:
    """Up, cruise and down to the end of the stretch: legs and w at its end.

    The ramps meet at w = (w0 + w1 + 2·A·n)/2 when that is below the top speed.
    """
    if x == stretch.end:
        return [], w
    gain, a = 2 * stretch.accel * (stretch.end - x), stretch.accel
    w1 = min(Fraction(bound), w + gain)
    if w > w1 + gain:
        raise ArithmeticError(f"w = {w} at {x} cannot be braked to {bound}: {stretch}")
    peak = min(Fraction(stretch.top), (w + w1 + gain) / 2)
    up = x + (peak - w) / (2 * a)
    down = stretch.end - (peak - w1) / (2 * a)
    fall = Leg(down, Fraction(stretch.end), peak, -a)
    return [Leg(x, up, w, a), Leg(up, down, peak, 0), fall], w1


def _brake(x: Position, w: Fraction, stretches: Iterable[Stretch], slow: int) -> list[Leg]:
    """Brake from position x to S (`slow` = S²); no leg when S or below already."""
    legs: list[Leg] = []
    for stretch in stretches:
        if w <= slow:
            break
        knee = x + (w - slow) / (2 * stretch.accel)
        end = min(knee, Fraction(stretch.end))
        legs.append(Leg(Fraction(x), end, w, -stretch.accel))
        x, w = end, legs[-1].w1
    return legs


def _join(legs: Iterable[Leg]) -> tuple[Leg, ...]:
    """Drop legs without way and make one of two that continue each other."""
    joined: list[Leg] = []
    for leg in legs:
        before = joined[-1] if joined else None
        if leg.x0 == leg.x1:
            continue
        if before and (before.a, before.w1) == (leg.a, leg.w0):
            joined[-1] = replace(before, x1=leg.x1)
        else:
            joined.append(leg)
    return tuple(joined)
