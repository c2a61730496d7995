"""What differs between a capture and a simulation, motor by motor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from rkm04_tools.compare.align import Alignment, Trains, align
from rkm04_tools.compare.clock import RATE_MAX, fit
from rkm04_tools.compare.follow import BEND_MAX, bend, follow
from rkm04_tools.compare.recording import Floats, Ints, Trace
from rkm04_tools.compare.simulated import UNKNOWN, Pulses

Bools: TypeAlias = NDArray[np.bool_]

DRIFT_SECONDS_PER_SECOND = 1e-6
"""How much the rates of two crystals may change during a capture."""
SHIFT_PULSES_MIN = 16
"""Fewer pulses fit somewhere by chance."""
JUMP_PULSES = 8
"""So many pulses on each side show that something is another way from there on."""
JUMP_SECONDS = 5.0
"""So long before and after a jump, the rate of the clocks is the same."""


@dataclass(frozen=True)
class Wires:
    """What was captured of a motor."""

    step: Trace
    direction: Trace | None


@dataclass(frozen=True)
class Span:
    """The shortest and the longest of some times, in seconds."""

    least: float
    most: float


@dataclass(frozen=True)
class Places:
    """Pulses that something is to be said about: numbers from 1, and seconds in the capture."""

    numbers: Ints
    seconds: Floats

    def __len__(self) -> int:
        return len(self.numbers)


@dataclass(frozen=True)
class Motor:
    """A motor in both recordings. Deviations are in seconds, positive: later than simulated.

    Numbers are those of the simulation's pulses, but those of surplus ones are the capture's.
    """

    motor: int
    captured: int
    simulated: int
    both: Places
    deviations: Floats
    missing: Places
    surplus: Places
    wrong_direction: Places
    too_far: Places
    outside: int
    """Pulses of the simulation before or after all of the capture; `missing` has none of them."""
    upside_down: bool
    """STEP is high between the pulses."""
    width: Span | None
    direction_setup: float | None
    """The shortest time from a change of DIR to the next pulse; and from a pulse to the next
    change."""
    direction_hold: float | None

    @property
    def worst(self) -> int | None:
        """The index of the pulse that is furthest off."""
        return int(np.argmax(np.abs(self.deviations))) if len(self.deviations) else None

    @property
    def is_same(self) -> bool:
        """Whether nothing differs."""
        faults = (self.missing, self.surplus, self.wrong_direction, self.too_far)
        return self.outside == 0 and not self.upside_down and not any(map(len, faults))


@dataclass(frozen=True)
class Allowed:
    """What counts as the same."""

    limit: float
    """Seconds that a pulse may be off."""
    part: bool
    """The capture is meant to hold only a part of the simulation."""
    begin: float
    end: float
    """The capture, in its own seconds."""


def wander(alignment: Alignment, trains: Trains) -> float:
    """How far the clock of the sections is from one line through everything."""
    far = 0.0
    for motor, (numbers, _) in alignment.pairs.items():
        if len(numbers):
            x = trains[motor][numbers]
            away = alignment.clock.capture(x) - alignment.overall.capture(x)
            far = max(far, float(np.abs(away).max()))
    return far


def wander_max(allowed: Allowed) -> float:
    """How far it may be."""
    return allowed.limit + DRIFT_SECONDS_PER_SECOND * (allowed.end - allowed.begin)


@dataclass(frozen=True)
class Shift:
    """Pulses that are missing where they should be, and are there so many seconds later."""

    motor: int
    first: int
    count: int
    seconds: float


def find_shift(
    alignment: Alignment, simulated: Trains, captured: Trains, finest: float, noise: float
) -> Shift | None:
    """Whether what is missing comes as a whole at another time; None if it does not."""
    left, come = _left(alignment, simulated, 0), _left(alignment, captured, 1)
    if min(sum(map(len, each.values())) for each in (left, come)) < SHIFT_PULSES_MIN:
        return None
    trains = {m: simulated[m][left[m]] for m in left}
    found = align(trains, {m: captured[m][come[m]] for m in come}, finest, noise, with_rate=True)
    if found is None or found.count < max(SHIFT_PULSES_MIN, sum(map(len, left.values())) / 2):
        return None
    motor = min((m for m in trains if len(trains[m])), key=lambda m: float(trains[m][0]))
    first = trains[motor][:1]
    later = float(found.clock.capture(first)[0] - alignment.clock.capture(first)[0])
    return Shift(motor, int(left[motor][0]) + 1, found.count, later)


@dataclass(frozen=True)
class Jump:
    """All pulses from this one on come so many seconds later."""

    motor: int
    pulse: int
    pause: float
    """The time without a pulse of any motor before it."""
    captured_seconds: float
    seconds: float


def find_jump(
    alignment: Alignment, simulated: Trains, captured: Trains, limit: float
) -> Jump | None:
    """Where all pulses come later, or earlier, from one to the next, if that explains the rest."""
    motors = [m for m, (i, _) in alignment.pairs.items() if len(i)]
    pairs = [alignment.pairs[m] for m in motors]
    x = np.concatenate([simulated[m][i] for m, (i, _) in zip(motors, pairs, strict=True)])
    y = np.concatenate([captured[m][j] for m, (_, j) in zip(motors, pairs, strict=True)])
    order = np.argsort(x, kind="stable")
    x, y = x[order], y[order]
    if len(x) < 2 * JUMP_PULSES:
        return None
    late = y - alignment.overall.capture(x)
    rows = np.lib.stride_tricks.sliding_window_view(late, JUMP_PULSES)
    low, high = rows.min(axis=1), rows.max(axis=1)
    apart = np.maximum(
        low[JUMP_PULSES:] - high[:-JUMP_PULSES], low[:-JUMP_PULSES] - high[JUMP_PULSES:]
    )
    at = int(np.argmax(apart)) + JUMP_PULSES
    if apart[at - JUMP_PULSES] <= limit:
        return None
    motor = np.repeat(motors, [len(i) for i, _ in pairs])[order[at]]
    number = int(np.concatenate([i for i, _ in pairs])[order[at]]) + 1
    pause = float(x[at] - x[at - 1])
    after = np.arange(len(x)) >= at
    seconds = _height(x - x[at], late, after, pause + JUMP_SECONDS)
    without = y - seconds * after
    line = fit(x, without, limit, RATE_MAX)
    if abs(seconds) <= limit or bend(follow(x, without, line, limit)) > BEND_MAX:
        return None
    return Jump(int(motor), number, pause, float(y[at]), seconds)


def _height(from_jump: Floats, late: Floats, after: Bools, near: float) -> float:
    """How high a jump is, if the rate is the same on both sides of it."""
    chosen = np.abs(from_jump) <= near
    columns = np.column_stack([np.ones(len(after)), from_jump, after])[chosen]
    return float(np.linalg.lstsq(columns, late[chosen], rcond=None)[0][2])


def _left(alignment: Alignment, trains: Trains, side: int) -> dict[int, Ints]:
    """The numbers from 0 of the pulses of each motor that belong to none."""
    none, pairs = np.empty(0, dtype=np.int64), alignment.pairs
    return {
        m: _rest(len(each), pairs[m][side] if m in pairs else none) for m, each in trains.items()
    }


def compare(
    motor: int, pulses: Pulses, wires: Wires, alignment: Alignment | None, allowed: Allowed
) -> Motor:
    """Compare what a motor should have done with what it did; None: nothing fits."""
    captured = wires.step.rises
    none = np.empty(0, dtype=np.int64)
    i, j = alignment.pairs.get(motor, (none, none)) if alignment else (none, none)
    expected = alignment.clock.capture(pulses.seconds) if alignment else pulses.seconds
    deviations = captured[j] - expected[i]
    both = Places(i + 1, captured[j])
    missing = _rest(len(expected), i)
    is_outside = np.zeros(len(missing), dtype=bool)
    if alignment:
        is_outside = (expected[missing] < allowed.begin) | (expected[missing] > allowed.end)
    return Motor(
        motor,
        len(captured),
        len(expected),
        both,
        deviations,
        _places(missing[~is_outside], expected),
        _places(_rest(len(captured), j), captured),
        _chosen(both, _is_wrong(pulses, i, wires, captured[j])),
        _chosen(both, np.abs(deviations) > allowed.limit),
        0 if allowed.part else int(is_outside.sum()),
        _is_upside_down(wires.step, allowed.limit),
        _width(wires.step, j),
        *_around(wires.direction, captured[j]),
    )


def _rest(count: int, taken: Ints) -> Ints:
    """The numbers from 0 that are not taken."""
    left = np.ones(count, dtype=bool)
    left[taken] = False
    return np.flatnonzero(left)


def _places(indices: Ints, seconds: Floats) -> Places:
    return Places(indices + 1, seconds[indices])


def _chosen(places: Places, which: Bools) -> Places:
    return Places(places.numbers[which], places.seconds[which])


def _is_wrong(pulses: Pulses, i: Ints, wires: Wires, seconds: Floats) -> Bools:
    """Which pulses go the other way; those whose way is not known go the right one."""
    wanted = pulses.directions[i]
    if wires.direction is None:
        return np.zeros(len(i), dtype=bool)
    wrong: Bools = (wanted != UNKNOWN) & (wires.direction.levels(seconds) != wanted)
    return wrong


def _is_upside_down(step: Trace, limit: float) -> bool:
    """Whether STEP is high for most of the longest interval: a pulse is half of one at most."""
    intervals = np.diff(step.rises)
    if not len(intervals):
        return False
    at = int(np.argmax(intervals))
    high = step.falls[step.level :][at] - step.rises[at]
    return bool(high > intervals[at] / 2 + limit)


def _width(step: Trace, j: Ints) -> Span | None:
    """How long the pulses are high; one that has not ended is left out."""
    falls = step.falls[step.level :]
    ended = j[j < len(falls)]
    if not len(ended):
        return None
    widths = falls[ended] - step.rises[ended]
    return Span(float(widths.min()), float(widths.max()))


def _around(direction: Trace | None, pulses: Floats) -> tuple[float | None, float | None]:
    """The shortest times between a change of DIR and a pulse after it, and before it."""
    if direction is None or not len(pulses) or not len(direction.edges):
        return None, None
    edges = direction.edges
    after = np.searchsorted(pulses, edges, side="left")
    setups = pulses[after[after < len(pulses)]] - edges[after < len(pulses)]
    holds = edges[after > 0] - pulses[after[after > 0] - 1]
    return (
        float(setups.min()) if len(setups) else None,
        float(holds.min()) if len(holds) else None,
    )
