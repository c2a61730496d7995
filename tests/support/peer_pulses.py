"""What is measured of a controller's pulses, whoever made them: deviation, corners, time.

`Train` has the times and positions of each axis' pulses. The ideal is taken from the train itself:
a pulse of an axis that makes d of the L steps of the longest axis belongs where that axis is at
(k - offset) * L / d. So a controller's ramps and speeds are no deviation, only what an axis does
beside the line.
"""

from __future__ import annotations

import bisect
import itertools
import math
import statistics
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

AXES = 3

Steps = tuple[int, int, int]


@dataclass
class Train:
    """What each axis did: times in seconds and positions after each pulse."""

    times: list[list[float]] = field(default_factory=lambda: [[] for _ in range(AXES)])
    positions: list[list[int]] = field(default_factory=lambda: [[] for _ in range(AXES)])

    def add(self, axis: int, seconds: float, way: int) -> None:
        """One pulse more."""
        last = self.positions[axis][-1] if self.positions[axis] else 0
        self.times[axis].append(seconds)
        self.positions[axis].append(last + way)

    def duration(self) -> float:
        """From the first pulse to the last one."""
        used = [times for times in self.times if times]
        return max(times[-1] for times in used) - min(times[0] for times in used)


@dataclass(frozen=True)
class Section:
    """A straight move and the pulses that belong to it."""

    steps: Steps
    """Of each axis, without sign."""
    times: tuple[list[float], ...]

    @property
    def longest(self) -> int:
        return self.steps.index(max(self.steps))

    def speeds(self) -> list[float]:
        """Of the tool, steps/s, between each two pulses of the longest axis."""
        times = self.times[self.longest]
        way = math.hypot(*self.steps) / max(self.steps)
        return [way / (after - before) for before, after in itertools.pairwise(times)]


def sections(train: Train, ends: Sequence[Steps]) -> Iterator[Section]:
    """The moves from each end to the next but those of no step; ValueError where the train was
    elsewhere at an end."""
    made = [0] * AXES
    for number, (begin, end) in enumerate(itertools.pairwise(ends), 1):
        steps = [abs(b - a) for a, b in zip(begin, end, strict=True)]
        parts = [each[m : m + s] for each, m, s in zip(train.times, made, steps, strict=True)]
        made = [m + s for m, s in zip(made, steps, strict=True)]
        for axis in range(AXES):
            there = train.positions[axis][made[axis] - 1 : made[axis]] or [0]
            if there[0] != end[axis] or len(parts[axis]) != steps[axis]:
                raise ValueError(f"move {number} does not end at {end}")
        if any(steps):
            yield Section((steps[0], steps[1], steps[2]), tuple(parts))
    if made != [len(each) for each in train.times]:
        raise ValueError("there are pulses after the last move")


def cubic(xs: Sequence[float], ys: Sequence[float], x: float) -> float:
    """The polynomial through four points."""
    total = 0.0
    for i, y in enumerate(ys):
        for j, other in enumerate(xs):
            if j != i:
                y *= (x - other) / (xs[i] - other)
        total += y
    return total


def off_the_line(times: Sequence[float], moment: float, wanted: float, offset: float) -> float:
    """How far the longest axis is from where it should be at a moment, in its steps.

    It is known at its pulses only. Between them its way is straight in a cruise, curved on a ramp,
    and both where a ramp is made of stairs: what is nearer to the ideal counts.
    """
    i = min(max(bisect.bisect_right(times, moment), 1), len(times) - 1)
    straight = i - offset + (moment - times[i - 1]) / (times[i] - times[i - 1])
    first = min(max(i - 2, 0), len(times) - 4)
    places = [first + k + 1 - offset for k in range(4)]
    curved = cubic(times[first : first + 4], places, moment)
    return min(abs(straight - wanted), abs(curved - wanted))


@dataclass(frozen=True)
class Deviation:
    """The worst of all pulses, each for itself."""

    pulses: float = 0.0
    """Of the pulse's own axis."""
    us: float = 0.0

    def worst(self, other: Deviation) -> Deviation:
        return Deviation(max(self.pulses, other.pulses), max(self.us, other.us))


def deviation_of(section: Section, offset: float) -> Deviation:
    """Of the axes that are not the longest one; moves of less than four steps are left out."""
    length = max(section.steps)
    times = section.times[section.longest]
    worst = Deviation()
    for axis in set(range(AXES)) - {section.longest} if length >= 4 else ():
        ratio = section.steps[axis] / length
        for k, moment in enumerate(section.times[axis], 1):
            wrong = off_the_line(times, moment, (k - offset) / ratio, offset)
            near = min(max(bisect.bisect_right(times, moment), 1), length - 1)
            period = times[near] - times[near - 1]
            worst = worst.worst(Deviation(wrong * ratio, wrong * period * 1e6))
    return worst


def deviation(train: Train, ends: Sequence[Steps], offset: float) -> Deviation:
    """The worst of a job.

    A controller gives its pulses at whole steps of the line (offset 0) or between two of them
    (1/2), on all axes alike; whichever it does is not a deviation.
    """
    worst = Deviation()
    for section in sections(train, ends):
        worst = worst.worst(deviation_of(section, offset))
    return worst


def corner_speeds(train: Train, ends: Sequence[Steps]) -> list[float]:
    """At each border of two moves, steps/s of the tool: the lesser one of the interval before the
    last one of the first move, and of the second one of the next; the intervals at the border
    itself may belong to two axes. Moves of less than three steps are left out."""
    pairs = itertools.pairwise(each.speeds() for each in sections(train, ends))
    return [min(a[-2], b[1]) for a, b in pairs if len(a) > 1 and len(b) > 1]


@dataclass(frozen=True)
class Circle:
    """In the plane of X and Y, in steps."""

    x: float
    y: float
    radius: float


def off_the_circles(train: Train, circles: Sequence[Circle]) -> float:
    """How far the tool is from the nearest circle at the worst, in steps."""
    events = sorted(
        (time, axis, place)
        for axis in (0, 1)
        for time, place in zip(train.times[axis], train.positions[axis], strict=True)
    )
    at, worst = [0, 0], 0.0
    for (_, axis, place), after in itertools.zip_longest(events, events[1:]):
        at[axis] = place
        if after is None or after[0] > _:
            ways = (abs(math.hypot(at[0] - c.x, at[1] - c.y) - c.radius) for c in circles)
            worst = max(worst, min(ways))
    return worst


def middle(values: Sequence[float]) -> float | None:
    """Their median; None if there are none."""
    return statistics.median(values) if values else None
