"""The fixed set of moves on which the accuracy of the step times is measured, group by group.

Each group stands for one way in which a step generator can go wrong: borders of the language's
ranges, moves so long that an error would add up, neighbouring sections that differ as much as they
can, and changes at every pulse of a move.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from itertools import product

from motion_probe import STOP, Move, single
from reference import ENDLESS, Section

START_SPEEDS = (1, 2, 100, 1999, 2000)
SPEEDS = (1, 2, 100, 2000, 15_999, 16_000)
ACCELS = (1, 2, 2000, 59_999, 60_000)
LONGEST = 16_000_000

MANUAL = Move(
    100,
    (
        Section(2000, 500, 2000),
        Section(2000, 2000, 2000),
        Section(5000, 500, 2000),
        Section(5000, 3000, 1000),
        Section(2000, 1500, 1000),
        Section(2000, 500, 1000),
    ),
)
"""The compound move of the manual's ninth example."""

SINGLE = single(100, 2000, 20_000, 300)
"""Reference move for changes: 99.75 steps of ramp, 100.5 of cruise, 99.75 of ramp."""

COMPOUND = Move(
    100,
    (
        Section(150, 1500, 8000),
        Section(60, 400, 20_000),
        Section(1, 16_000, 1),
        Section(200, 2500, 12_000),
    ),
)
"""Reference move for changes: borders where it brakes, a section of one step, a peak."""

CHANGE_SPEEDS = (1, 50, 100, 101, 1500, 5000, 16_000)
"""New speeds: far below S, below it, S, beside it, below V, above it, the most there is."""

PEERS = {
    "M1": single(100, 3000, 2000, 1000),
    "M2": single(2000, 16_000, 60_000, 100_000),
    "M3": single(100, 500, 1, 2000),
    "M4": single(1000, 200_000, 1_000_000, 1_000_000),
}
"""Moves on which other step generators have been measured; M4 is beyond the language."""

Moves = Iterator[Move]


def corners_short(_: random.Random) -> Moves:
    """Every corner of S, V and A with 1, 2, 3 and 7 steps."""
    for start, speed, accel, steps in product(START_SPEEDS, SPEEDS, ACCELS, (1, 2, 3, 7)):
        yield single(start, speed, accel, steps)


def corners_ramps(_: random.Random) -> Moves:
    """Corners with 1000 and 1001 steps, most of them nothing but ramps that meet."""
    for start, speed, accel, steps in product(
        START_SPEEDS, SPEEDS, (1, 2000, 60_000), (1000, 1001)
    ):
        yield single(start, speed, accel, steps)


def corners_long(_: random.Random) -> Moves:
    """Corners with a hundred thousand steps, a million, and the most that there are."""
    lengths = (100_000, 1_000_000, LONGEST)
    for start, speed, accel, steps in product((1, 100, 2000), SPEEDS, (1, 2000, 60_000), lengths):
        yield single(start, speed, accel, steps)


def compound_extremes(_: random.Random) -> Moves:
    """Ten sections whose neighbours differ as much as the language allows."""
    mostly_one = (1, LONGEST, 1, 1, 1, 1, 1, LONGEST - 1, 1, 1)
    steps = ((1,), mostly_one, (2, 1, 1000), (3000, 1), (1000, 999))
    speeds = ((1, 16_000), (16_000, 16_000, 1), (1, 2, 100, 2000, 16_000))
    accels = ((1, 60_000), (1, 1, 60_000), (60_000,))
    for start, n, v, a in product((1, 2000), steps, speeds, accels):
        yield Move(start, tuple(Section(*each) for each in _ten(n, v, a)))


def compound_longest(_: random.Random) -> Moves:
    """The manual's example, and ten sections of 16 000 000 steps each."""
    yield MANUAL
    yield Move(1, tuple(Section(*each) for each in _ten((LONGEST,), (16_000, 1999), (1, 60_000))))


def compound_random(rng: random.Random) -> Moves:
    """Compound moves drawn at random, ends of the ranges among them."""
    for _ in range(150):
        sections = rng.randint(2, 10)
        yield Move(
            _draw(rng, 2000),
            tuple(
                Section(_draw(rng, 600), _draw(rng, 16_000), _draw(rng, 60_000))
                for _ in range(sections)
            ),
        )


def stops(_: random.Random) -> Moves:
    """A stop at every pulse of a single and of a compound move."""
    for move in (SINGLE, COMPOUND):
        for pulse in range(1, _last(move) + 1):
            yield Move(move.start_speed, move.sections, ((pulse, STOP),))


def speed_changes(_: random.Random) -> Moves:
    """A change of speed at every pulse of a single and of a compound move."""
    for move in (SINGLE, COMPOUND):
        for speed, pulse in product(CHANGE_SPEEDS, range(1, _last(move) + 1)):
            yield Move(move.start_speed, move.sections, ((pulse, speed),))


def several_changes(rng: random.Random) -> Moves:
    """One or two changes of speed, then a stop, at pulses and with speeds drawn at random."""
    for _ in range(600):
        move = rng.choice((SINGLE, COMPOUND, MANUAL))
        pulses = sorted(rng.sample(range(1, min(_last(move), 6000) + 1), rng.choice((2, 3))))
        speeds = [*(rng.choice((*CHANGE_SPEEDS, rng.randint(1, 16_000))) for _ in pulses[1:]), STOP]
        yield Move(move.start_speed, move.sections, tuple(zip(pulses, speeds, strict=True)))


def endless_runs(_: random.Random) -> Moves:
    """Runs without end that are stopped, on the ramp and after it."""
    for start, speed, accel in product((1, 2000), (1, 16_000), (1, 60_000)):
        run = Section(ENDLESS, speed, accel)
        for pulse in (1, 2, 1000, 1_000_000):
            yield Move(start, (run,), ((pulse, STOP),))
            yield Move(start, (run,), ((pulse, 3000), (pulse + 500, STOP)))


GROUPS: tuple[Callable[[random.Random], Moves], ...] = (
    corners_short,
    corners_ramps,
    corners_long,
    compound_extremes,
    compound_longest,
    compound_random,
    stops,
    speed_changes,
    several_changes,
    endless_runs,
)


def _last(move: Move) -> int:
    last = move.curve.last
    assert last is not None
    return last


def _ten(*patterns: Sequence[int]) -> Iterator[tuple[int, ...]]:
    """Repeat the patterns until there are ten sections."""
    for i in range(10):
        yield tuple(pattern[i % len(pattern)] for pattern in patterns)


def _draw(rng: random.Random, high: int) -> int:
    """Draw from 1 to `high`: its ends, or every order of size alike."""
    return rng.choice((1, high, round(high ** rng.random()), round(high ** rng.random())))
