"""Which captured pulse is which pulse of the simulation, when the clocks differ and pulses do too.

A few intervals in a row that agree are where it begins. From there on pulses are paired outwards,
each time with the clocks as the pulses next to it have shown them: an interval is much longer than
what clocks drift apart from one section to the next. Of some places to begin at, the one with the
most pairs is right.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from rkm04_tools.compare.clock import RATE_MAX, Clock, Line, fit
from rkm04_tools.compare.recording import Floats, Ints

SECTION_SECONDS = 2.0
SECTION_PULSES = 64
"""A section of the clock is at least so long, and has at least so many pulses."""
RATE_PULSES_MIN = 8
"""With fewer pulses a rate is not told from how they fell between samples."""
NEXT_PULSES = 16
REACH = 0.3
"""How much of the interval to its neighbour a pulse may be off and still be that pulse ..."""
REACH_SECONDS = 50e-6
"""... and how much it may be off at all."""
WINDOWS = (12, 6, 3, 1)
WINDOWS_TRIED = 64
PLACES_TRIED = 16

Pairs = dict[int, tuple[Ints, Ints]]
"""Of each motor, the numbers from 0 of simulated and captured pulses that belong together."""
Trains = Mapping[int, Floats]
"""Of each motor, the times of its pulses in seconds, ascending."""


@dataclass(frozen=True)
class Alignment:
    """The clocks, and what belongs together by them."""

    clock: Clock
    overall: Line
    """The one line through everything."""
    has_rate: bool
    pairs: Pairs
    elsewhere: bool = False
    """The capture fits as well at another place."""

    @property
    def count(self) -> int:
        """The number of pairs."""
        return sum(len(simulated) for simulated, _ in self.pairs.values())


@dataclass(frozen=True)
class _Trains:
    """What is to be aligned."""

    simulated: Trains
    captured: Trains
    gaps: Mapping[int, Floats]
    """Of each simulated pulse, the interval to the nearer neighbour."""
    all_simulated: Floats
    """The pulses of all motors, ascending."""
    resolution: float
    rate_max: float


def align(
    simulated: Trains, captured: Trains, resolution: float, with_rate: bool
) -> Alignment | None:
    """Align the pulses of the motors that are in both; None if nothing fits."""
    motors = [m for m in simulated if len(simulated[m]) and len(captured.get(m, ()))]
    if not motors:
        return None
    trains = _Trains(
        {m: simulated[m] for m in motors},
        {m: captured[m] for m in motors},
        {m: _gaps(simulated[m]) for m in motors},
        np.sort(np.concatenate([simulated[m] for m in motors])),
        resolution,
        RATE_MAX if with_rate else 0.0,
    )
    perfect = min(sum(map(len, each.values())) for each in (trains.simulated, trains.captured))
    best: Alignment | None = None
    tried: list[Alignment] = []
    for motor, i, j in _places(trains):
        if any(_has_pair(trains, each, motor, i, j) for each in tried):
            continue
        found = _from(trains, motor, i, j)
        tried.append(found)
        if best is None or found.count > best.count:
            best = found
        elif found.count == best.count:
            best = Alignment(best.clock, best.overall, best.has_rate, best.pairs, elsewhere=True)
        if len(tried) == PLACES_TRIED or (best.count == perfect == len(trains.all_simulated)):
            break
    return best


def _gaps(pulses: Floats) -> Floats:
    between = np.diff(pulses)
    nearer: Floats = np.minimum(np.append(between, np.inf), np.insert(between, 0, np.inf))
    return nearer


def _places(trains: _Trains) -> Iterator[tuple[int, int, int]]:
    """Motor and two pulses that may belong together, the likeliest first."""
    motors = sorted(trains.simulated, key=lambda m: -min(_lengths(trains, m)))
    for size in WINDOWS:
        rows = [row for motor in motors for row in _windows(trains, motor, size)]
        for _, motor, j, found in sorted(rows, key=lambda row: row[:3]):
            for i in found[:: max(1, len(found) // PLACES_TRIED)]:
                yield motor, int(i), j
        if rows:
            return
    for motor in motors:
        n, m = _lengths(trains, motor)
        yield from [(motor, 0, 0), (motor, n - 1, m - 1), (motor, 0, m - 1), (motor, n - 1, 0)]


def _lengths(trains: _Trains, motor: int) -> tuple[int, int]:
    return len(trains.simulated[motor]), len(trains.captured[motor])


def _windows(trains: _Trains, motor: int, size: int) -> Iterator[tuple[int, int, int, Ints]]:
    """Intervals in a row of the capture: in how many places of the simulation they are, and where.

    Half of them are taken where intervals change most, as in ramps and at the ends of moves.
    """
    between, seen = np.diff(trains.simulated[motor]), np.diff(trains.captured[motor])
    last = len(seen) - size
    if last < 0 or len(between) < size:
        return
    half = WINDOWS_TRIED // 2
    change = np.abs(np.diff(np.log(np.maximum(seen, 1e-9))))
    starts = {int(at) for at in np.linspace(0, last, half)}
    starts |= {int(at) - size // 2 for at in np.argsort(-change, kind="stable")[:half]}
    for j in sorted(at for at in starts if 0 <= at <= last):
        found = np.arange(len(between) - size + 1)
        for k in range(size):
            slack = 2 * trains.resolution + (trains.rate_max or 1e-9) * seen[j + k]
            found = found[np.abs(between[found + k] - seen[j + k]) <= slack]
        if len(found):
            yield len(found), motor, j, found


def _has_pair(trains: _Trains, alignment: Alignment, motor: int, i: int, j: int) -> bool:
    """Whether an alignment would pair these two, too."""
    expected = alignment.clock.capture(trains.simulated[motor][i : i + 1])[0]
    away = abs(float(trains.captured[motor][j] - expected))
    return away <= min(REACH * float(trains.gaps[motor][i]), REACH_SECONDS)


def _from(trains: _Trains, motor: int, i: int, j: int) -> Alignment:
    """Align everything from a first pair on."""
    x = float(trains.simulated[motor][i])
    line = Line(x, float(trains.captured[motor][j]) - x, 0.0)
    if trains.rate_max == 0:
        line = _fitted(trains, pair(trains, Clock([x], [line]), -np.inf, np.inf), line)
        return _finish(trains, Clock([x], [line]))
    low, high, line = _grow(trains, x, line)
    starts, lines = [low], [line]
    for start, later in _follow(trains, high, line, forward=True):
        starts.append(start)
        lines.append(later)
    for start, earlier in _follow(trains, low, line, forward=False):
        starts.insert(0, start)
        lines.insert(0, earlier)
    return _finish(trains, Clock(starts, lines))


def _grow(trains: _Trains, x: float, line: Line) -> tuple[float, float, Line]:
    """Pair more and more on both sides, until it is a section."""
    low = high = x
    pulses = trains.all_simulated
    while True:
        span = high - low
        low = min(low - span, _nth(pulses, low, -NEXT_PULSES))
        high = max(high + span, _nth(pulses, high, NEXT_PULSES))
        low, high = max(low, float(pulses[0])), min(high, float(pulses[-1]))
        line = _fitted(trains, pair(trains, Clock([low], [line]), low, high), line)
        if high - low >= SECTION_SECONDS or (low <= pulses[0] and high >= pulses[-1]):
            return low, high, line


def _follow(
    trains: _Trains, at: float, line: Line, *, forward: bool
) -> Iterator[tuple[float, Line]]:
    """Go on to one end, section by section; start and line of each."""
    pulses = trains.all_simulated
    sign = 1 if forward else -1
    back = at - sign * SECTION_SECONDS
    while at < pulses[-1] if forward else at > pulses[0]:
        end = at + sign * SECTION_SECONDS
        far = _nth(pulses, at, sign * SECTION_PULSES)
        end = max(end, far) if forward else min(end, far)
        # What is paired reaches back by a section, so that a rate is well known where it changes.
        line = _reach(trains, line, at, end)
        line = _fitted(trains, pair(trains, Clock([at], [line]), *sorted((back, end))), line)
        yield (at if forward else end), line
        back, at = at, end


def _reach(trains: _Trains, line: Line, at: float, end: float) -> Line:
    """The line, corrected by the pulses that come first after a pause."""
    low, high = sorted((at, end))
    found = pair(trains, Clock([low], [line]), low, high)
    return _fitted(trains, found, line) if _count(found) >= SECTION_PULSES else line


def _nth(pulses: Floats, at: float, count: int) -> float:
    """The time of a pulse so many after a time, or before it."""
    index = int(np.searchsorted(pulses, at, side="right" if count > 0 else "left")) + count
    index -= 1 if count > 0 else 0
    return float(pulses[min(max(index, 0), len(pulses) - 1)])


def _count(pairs: Pairs) -> int:
    return sum(len(simulated) for simulated, _ in pairs.values())


def _fitted(trains: _Trains, pairs: Pairs, line: Line) -> Line:
    """The line through pairs; as before where there are too few."""
    if not _count(pairs):
        return line
    x, y = _points(trains, pairs)
    enough = len(x) >= RATE_PULSES_MIN and float(np.ptp(x)) * RATE_MAX > trains.resolution
    if enough:
        return fit(x, y, trains.resolution, trains.rate_max)
    offset = fit(x + line.rate * (x - line.x0), y, trains.resolution, 0.0)
    return Line(line.x0, offset.y, line.rate)


def _points(trains: _Trains, pairs: Pairs) -> tuple[Floats, Floats]:
    """The times of pairs of all motors, by time."""
    x = np.concatenate([trains.simulated[m][i] for m, (i, _) in pairs.items()])
    y = np.concatenate([trains.captured[m][j] for m, (_, j) in pairs.items()])
    order = np.argsort(x, kind="stable")
    return x[order], y[order]


def pair(trains: _Trains, clock: Clock, low: float, high: float) -> Pairs:
    """Pair the pulses of each motor between two times of the simulation."""
    pairs: Pairs = {}
    for motor, simulated in trains.simulated.items():
        first = int(np.searchsorted(simulated, low, side="left"))
        end = int(np.searchsorted(simulated, high, side="right"))
        expected = clock.capture(simulated[first:end])
        reach = np.minimum(REACH * trains.gaps[motor][first:end], REACH_SECONDS)
        i, j = _nearest(expected, trains.captured[motor], reach)
        pairs[motor] = i + first, j
    return pairs


def _nearest(expected: Floats, captured: Floats, reach: Floats) -> tuple[Ints, Ints]:
    """Pair what is nearest to each other, and within reach."""
    after = np.clip(np.searchsorted(captured, expected), 0, len(captured) - 1)
    before = np.clip(after - 1, 0, None)
    is_before = np.abs(captured[before] - expected) <= np.abs(captured[after] - expected)
    j = np.where(is_before, before, after)
    away = np.abs(captured[j] - expected)
    i = np.flatnonzero(away <= reach)
    best = i[np.lexsort((away[i], j[i]))]
    _, first = np.unique(j[best], return_index=True)
    chosen = best[first]
    return chosen, j[chosen]


def _finish(trains: _Trains, clock: Clock) -> Alignment:
    """Pair everything by a clock that is fitted to each section alone."""
    pairs = pair(trains, clock, -np.inf, np.inf)
    has_rate = trains.rate_max > 0 and _count(pairs) >= RATE_PULSES_MIN
    if not _count(pairs):
        return Alignment(clock, clock.lines[0], False, pairs)
    if has_rate:
        for _ in range(2):
            clock = _sections(trains, *_points(trains, pairs))
            pairs = pair(trains, clock, -np.inf, np.inf)
    x, y = _points(trains, pairs)
    overall = fit(x, y, trains.resolution, trains.rate_max if has_rate else 0.0)
    return Alignment(clock, overall, has_rate, pairs)


def _sections(trains: _Trains, x: Floats, y: Floats) -> Clock:
    """A line for each section of pairs; a short rest at the end belongs to the one before."""
    starts, lines = [], []
    at = 0
    while at < len(x):
        end = max(int(np.searchsorted(x, x[at] + SECTION_SECONDS)), at + SECTION_PULSES)
        if len(x) - end < SECTION_PULSES or x[-1] - x[min(end, len(x) - 1)] < SECTION_SECONDS / 2:
            end = len(x)
        starts.append(float(x[at]))
        lines.append(fit(x[at:end], y[at:end], trains.resolution, trains.rate_max))
        at = end
    return Clock(starts, lines)
