"""Which captured pulse is which pulse of the simulation, when the clocks differ and pulses do too.

A few intervals in a row that agree are where it begins. From there on pulses are paired outwards,
each time with the clocks as the pulses next to it have shown them: an interval is much longer than
what clocks drift apart from one section to the next. Of some places to begin at, the one with the
most pairs is right.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rkm04_tools.compare.clock import RATE_MAX, Clock, Line, fit
from rkm04_tools.compare.follow import follow
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
WINDOWS = (12, 6, 3)
SURE_WINDOW = 6
WINDOWS_TRIED = 64
PLACES_OF_WINDOW = 4
PLACES_TRIED = 24
ALIKE_MAX = 20_000
FITS_PART = 0.25
"""Fewer pairs than so much of all pulses are together by chance."""
SURE_PART = 0.9
"""A place that nothing else looks like is right if so much of all pulses is paired from there."""

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
    noise: float
    """How far a pulse may be off that is where it should be."""
    rate_max: float


@dataclass(frozen=True)
class _Place:
    """Two pulses, counted from 0, that may belong together; `is_only`: nothing else looks so."""

    motor: int
    simulated: int
    captured: int
    is_only: bool = False


def align(
    simulated: Trains, captured: Trains, resolution: float, noise: float, with_rate: bool
) -> Alignment | None:
    """Align the pulses of the motors that are in both; None if nothing fits.

    `noise` is how far a pulse may be off that is where it should be.
    """
    motors = [m for m in simulated if len(simulated[m]) and len(captured.get(m, ()))]
    if not motors:
        return None
    trains = _Trains(
        {m: simulated[m] for m in motors},
        {m: captured[m] for m in motors},
        {m: _gaps(simulated[m]) for m in motors},
        np.sort(np.concatenate([simulated[m] for m in motors])),
        resolution,
        noise,
        RATE_MAX if with_rate else 0.0,
    )
    perfect = min(sum(map(len, each.values())) for each in (trains.simulated, trains.captured))
    best: Alignment | None = None
    tried: list[Clock] = []
    for place in _places(trains):
        if any(_has_pair(trains, clock, place) for clock in tried):
            continue
        found = _from(trains, place)
        tried.append(found.clock)
        if best is None or found.count > best.count:
            best = found
        elif found.count == best.count:
            best = replace(best, elsewhere=True)
        is_sure = place.is_only and found.count >= SURE_PART * perfect
        if is_sure or found.count == len(trains.all_simulated) or len(tried) == PLACES_TRIED:
            break
    return best if best and best.count >= FITS_PART * perfect else None


def _gaps(pulses: Floats) -> Floats:
    between = np.diff(pulses)
    nearer: Floats = np.minimum(np.append(between, np.inf), np.insert(between, 0, np.inf))
    return nearer


def _places(trains: _Trains) -> Iterator[_Place]:
    """Pulses that may belong together, the likeliest first."""
    motors = sorted(trains.simulated, key=lambda m: -min(_lengths(trains, m)))
    for sizes in (WINDOWS, (1,)):
        rows = [row for motor in motors for row in _windows(trains, motor, sizes)]
        for row in sorted(rows, key=lambda row: (row.count, -row.size, row.motor, row.captured)):
            is_only = row.count == 1 and row.size >= SURE_WINDOW
            for i in row.simulated[:: -(-len(row.simulated) // PLACES_OF_WINDOW)]:
                yield _Place(row.motor, int(i), row.captured, is_only)
        if rows:
            return
    for motor in motors:
        n, m = _lengths(trains, motor)
        for i, j in ((0, 0), (n - 1, m - 1), (0, m - 1), (n - 1, 0)):
            yield _Place(motor, i, j)


def _lengths(trains: _Trains, motor: int) -> tuple[int, int]:
    return len(trains.simulated[motor]), len(trains.captured[motor])


@dataclass(frozen=True)
class _Window:
    """Intervals in a row of the capture, from a pulse on, and the places that look so.

    `simulated` are the first pulses of these places, or of some of them; `count` is their number.
    """

    motor: int
    size: int
    captured: int
    count: int
    simulated: Ints


def _windows(trains: _Trains, motor: int, sizes: Sequence[int]) -> Iterator[_Window]:
    """Windows that look like places of the simulation.

    Half of them are taken where intervals change most, as in ramps and at the ends of moves.
    """
    between, seen = np.diff(trains.simulated[motor]), np.diff(trains.captured[motor])
    half = WINDOWS_TRIED // 2
    changed = np.argsort(-np.abs(np.diff(np.log(np.maximum(seen, 1e-9)))), kind="stable")[:half]
    order = np.argsort(between, kind="stable")
    slack = 2 * trains.resolution + (trains.rate_max or 1e-9) * seen
    for size in sizes:
        last = len(seen) - size
        if last < 0 or len(between) < size:
            continue
        starts = {int(at) for at in np.linspace(0, last, half)}
        starts |= {int(at) - size // 2 for at in changed}
        for j in sorted(at for at in starts if 0 <= at <= last):
            count, found = _alike(between, order, seen[j : j + size], slack[j : j + size])
            if count:
                yield _Window(motor, size, j, count, found)


def _alike(between: Floats, order: Ints, seen: Floats, slack: Floats) -> tuple[int, Ints]:
    """In how many places intervals are as these ones, within slack, and where.

    Of too many places only some are looked at; then the count is no less than that of these.
    """
    first = np.searchsorted(between, seen - slack, side="left", sorter=order)
    end = np.searchsorted(between, seen + slack, side="right", sorter=order)
    rarest = int(np.argmin(end - first))
    every = 1 + int(end[rarest] - first[rarest]) // ALIKE_MAX
    found = np.sort(order[first[rarest] : end[rarest] : every]) - rarest
    found = found[(found >= 0) & (found <= len(between) - len(seen))]
    for k in range(len(seen)):
        found = found[np.abs(between[found + k] - seen[k]) <= slack[k]]
    return every * len(found), found


def _has_pair(trains: _Trains, clock: Clock, place: _Place) -> bool:
    """Whether a clock would pair these two, too."""
    i = place.simulated
    expected = clock.capture(trains.simulated[place.motor][i : i + 1])[0]
    away = abs(float(trains.captured[place.motor][place.captured] - expected))
    return away <= min(REACH * float(trains.gaps[place.motor][i]), REACH_SECONDS)


def _from(trains: _Trains, place: _Place) -> Alignment:
    """Align everything from a first pair on."""
    x = float(trains.simulated[place.motor][place.simulated])
    line = Line(x, float(trains.captured[place.motor][place.captured]) - x, 0.0)
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
    if (np.diff(j[i]) == 0).any():
        nearest_first = i[np.lexsort((away[i], j[i]))]
        _, first = np.unique(j[nearest_first], return_index=True)
        i = nearest_first[first]
    return i, j[i]


def _finish(trains: _Trains, clock: Clock) -> Alignment:
    """Pair everything by a clock that is fitted to each section alone; then one for the whole."""
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
    if has_rate:
        clock = _whole(trains, x, y, clock, overall)
    return Alignment(clock, overall, has_rate, pairs)


def _whole(trains: _Trains, x: Floats, y: Floats, sections: Clock, overall: Line) -> Clock:
    """The clock of all pairs but the faulty ones."""
    good = np.abs(y - sections.capture(x)) <= trains.noise
    return follow(x[good], y[good], overall, trains.noise)


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
