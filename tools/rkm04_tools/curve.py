"""Lines of speed and position over time, from pulses and moves, thin enough to draw."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rkm04_tools.record import Floats, Ints, Move, Pulses

COLUMNS = 2000
"""More columns than the drawing has pixels across."""

REST = 4
"""An interval so many times as long as those beside it is a rest: no ramp makes more than 2.5."""


def speed_line(
    pulses: Pulses, moves: Sequence[Move], hz: int, signs: Ints | None = None
) -> tuple[Floats, Floats]:
    """Seconds and steps/s: the mean speed of each interval in its middle, 0 outside moves.

    The first interval of a move counts from its start. `signs` are the directions of the pulses
    where they are not those of their moves: then a motor may rest in a move, too.
    """
    if not moves or not len(pulses.tick):
        return np.zeros(0), np.zeros(0)
    start = np.array([m.start for m in moves], dtype=np.int64)
    end = np.array([m.end for m in moves], dtype=np.int64)
    sign = np.array([m.sign for m in moves], dtype=np.int64)
    own = np.maximum(np.searchsorted(start, pulses.tick, side="left") - 1, 0)
    before = np.maximum(np.concatenate(([0], pulses.tick[:-1])), start[own])
    interval = np.maximum(pulses.tick - before, 1)
    rests = np.zeros(len(interval), np.bool_) if signs is None else _rests(interval, own)
    speed = (sign[own] if signs is None else signs) * ~rests * hz / interval
    first = np.searchsorted(pulses.tick, start, side="right")
    last = np.searchsorted(pulses.tick, end, side="right") - 1
    moved = last >= first
    start, end, first, last = start[moved], end[moved], first[moved], last[moved]
    corners = np.stack([start, start, end, end], axis=1) / hz
    zero = np.zeros(len(start))
    stands = np.array([m.done for m in moves])[moved]
    lies = (end - pulses.tick[last] > REST * interval[last]) & (last > first) & (signs is not None)
    leaves = speed[last] * ~lies
    edges = np.stack([zero, speed[first], leaves, leaves * ~stands], axis=1)
    at = np.stack([first, first, last + 1, last + 1], axis=1).ravel()
    ends = np.concatenate((np.flatnonzero(rests), last[lies]))  # of rests, or where one begins
    time = np.where(rests, before, (pulses.tick + before) / 2.0) / hz
    at = np.concatenate((ends + 1, at))
    time = np.insert(time, at, np.concatenate((pulses.tick[ends] / hz, corners.ravel())))
    return time, np.insert(speed, at, np.concatenate((np.zeros(len(ends)), edges.ravel())))


def _rests(interval: Ints, own: Ints) -> NDArray[np.bool_]:
    """Which intervals of a motor's moves are rests; `own` is the move of each."""
    same = own[1:] == own[:-1]
    beside = np.zeros(len(interval), np.int64)
    beside[1:] = np.where(same, interval[:-1], 0)
    beside[:-1] = np.maximum(beside[:-1], np.where(same, interval[1:], 0))
    return (beside > 0) & (interval > REST * beside)


def thinned(time: Floats, value: Floats, end: float) -> tuple[Floats, Floats]:
    """At most four points a column: the first, the least and greatest, and the last of each."""
    if len(time) <= 4 * COLUMNS or end <= 0:
        return time, value
    column = (time * (COLUMNS / end)).astype(np.int64)
    first = np.flatnonzero(np.diff(column, prepend=-1))
    last = np.append(first[1:], len(time)) - 1
    least = np.minimum.reduceat(value, first)
    greatest = np.maximum.reduceat(value, first)
    falls = value[first] > value[last]
    one, other = np.where(falls, greatest, least), np.where(falls, least, greatest)
    times = np.stack([time[first], time[first], time[last], time[last]], axis=1)
    values = np.stack([value[first], one, other, value[last]], axis=1)
    return times.ravel(), values.ravel()


def position_line(pulses: Pulses, first: int, end: float, hz: int) -> tuple[Floats, Floats]:
    """Seconds and steps: corners of a line that keeps each position until the next pulse.

    `first` is the position at the start.
    """
    position = pulses.position
    time = np.concatenate(([0.0], pulses.tick / hz, [end]))
    steps = np.concatenate(([first], position, position[-1:]))
    return time, steps.astype(np.float64)
