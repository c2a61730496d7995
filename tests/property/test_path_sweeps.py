"""Stops, holds, other speeds and more vectors at every pulse of reference chains, and any two.

Each run is laid beside the exact reference: which of them take effect, where the path rests, every
pulse of every axis, none too many, and how long DIR may stand still. The moments are those of the
pulses of the longest axis, the ticks beside them, and some between two. `RKM04_LONG=1` tries all of
them, and more pairs.
"""

from __future__ import annotations

import os
import random
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise, product

import pytest
from chance import SEED, epoch
from path_chains import ACCEL_MAX, SPEED_MAX, vector
from path_probe import (
    ADD,
    AHEAD,
    BRAKE,
    GO,
    JOIN,
    LATER,
    NEVER,
    SECTION,
    SPEED,
    STOP,
    Case,
    Change,
    Made,
    Run,
    deviation,
    ideal,
    run,
)
from path_reference import ACCEL_UNITS, ROOT_BITS, SPEED_UNITS, Path, Vector
from reference import TICK_HZ

GOAL_TICKS = 0.65
LONG = bool(os.environ.get("RKM04_LONG"))
SINGLES = 10**6 if LONG else 60
PAIRS = 10_000 if LONG else 60
"""So many runs of each chain, of some thousands with one change and some 100 000 with two."""

MORE = 2
"""The last so many vectors of a chain are not there at the start, but are added by a change; with a
start speed they would wait for the next start, and all are there."""

TICKS_PER_US = TICK_HZ // 10**6


def chain(*vectors: Vector, start_speed: float = 0, turn_us: int = 12) -> Case:
    """Return a chain; its start speed is in steps/s."""
    known = len(vectors) - (MORE if start_speed == 0 else 0)
    return Case(vectors, known, start_speed=round(start_speed * SPEED_UNITS), turn_us=turn_us)


LINE = (
    vector((20, 0, 0, 0), 900, 9000),
    vector((3, 0, 0, 0), 16_000, 128),
    vector((11, 0, 0, 0), 250, 12_000),
    vector((6, 0, 0, 0), 1200, 9000),
)
TURNS = (
    vector((14, -9, 0, 3), 3000, 90_000),
    vector((-5, -7, 1, 0), 5000, 60_000),
    vector((1, 1, -1, 0), 2000, 1000),
    vector((-4, 8, -8, 5), 6000, ACCEL_MAX),
    vector((9, -2, 3, -3), 900, 40_000),
)
FAST = (
    vector((30, 29, -15, 1), SPEED_MAX, ACCEL_MAX),
    vector((2, 24, -23, 0), 150_000, ACCEL_MAX),
    vector((25, -24, 12, 0), SPEED_MAX, ACCEL_MAX),
    vector((-1, 2, 2, 0), SPEED_MAX, ACCEL_MAX),
)
CHAINS = {
    "one axis": chain(*LINE),
    "one axis with a start speed": chain(*LINE, start_speed=300),
    "corners, and axes that rest": chain(
        vector((13, 5, 0, 0), 1000, 20_000),
        vector((4, 12, 7, 0), 1400, 30_000),
        vector((0, 0, 9, 2), 700, 15_000),
        vector((0, 6, 0, 0), 1000, 20_000),
    ),
    "turns": chain(*TURNS),
    "turns of a slow DIR": chain(*TURNS, turn_us=500),
    "turns with a start speed": chain(*TURNS, start_speed=800),
    "vectors of a step": chain(
        *(vector((1, d, -d, 1), 20_000, 500_000) for d in (1, 0, -1, 1) * 3),
        vector((0, 0, 0, -1), 20_000, 500_000),
    ),
    "fast": chain(*FAST),
    "fast with a start speed": chain(*FAST, start_speed=100_000),
    "border speeds": chain(
        vector((12, 12, -3, 4), 4000, 300_000, border=0, extent2=297),
        vector((10, 12, 3, 4), 4000, 300_000, border=256_000, extent2=253),
        vector((8, 1, 3, 0), 4000, 200_000, border=5, extent2=74),
        vector((8, 9, -5, 1), 3000, 300_000, border=0),
        vector((3, 4, -5, 1), 3000, 300_000),
    ),
    "crawling": chain(
        vector((4, 3, -1, 0), 0.7, 0.3),
        vector((3, -2, 0, 1), 5, 100),
        vector((5, 1, 1, 1), 1 / SPEED_UNITS, 1 / ACCEL_UNITS),
        vector((2, 1, 0, 1), 0.7, 0.3),
    ),
}
BRIEF = {
    "one axis": Case(LINE[-2:], 1),
    "turns": chain(TURNS[2], TURNS[3], TURNS[2], TURNS[1]),
    "turns with a start speed": chain(TURNS[2], TURNS[3], TURNS[2], TURNS[1], start_speed=800),
    "fast": chain(FAST[3], vector((7, 2, -5, 0), SPEED_MAX, ACCEL_MAX), FAST[3], FAST[3]),
    "crawling": chain(*CHAINS["crawling"].vectors[1:]),
}
"""Those of which pairs are tried."""


def kinds_of(case: Case) -> list[Change]:
    """Return what may happen to a chain, at no tick yet."""
    speeds = [v.speed for v in case.vectors]
    accels = [v.accel for v in case.vectors]
    soon, low, high = min(TICK_HZ, AHEAD), max(1, min(speeds) // 3), SPEED_MAX * SPEED_UNITS
    return [
        *(Change(STOP, 0, delay, patience) for delay, patience in ((0, NEVER), (1, 0), (soon, 0))),
        Change(STOP, 0, 3, NEVER, max(1, min(accels) // 5)),
        Change(STOP, 0, 3, 0, min(ACCEL_MAX * ACCEL_UNITS, 9 * max(accels))),
        Change(BRAKE, 0, 0, 0),
        *(Change(SPEED, 0, v, NEVER) for v in (low, max(speeds), high)),
        *(Change(SPEED, 0, v, 0) for v in (low, max(speeds) // 2 + 1, case.start_speed or 1)),
        *(Change(SECTION, 0, v, p) for v, p in ((low, 0), (high, NEVER))),
        *(Change(LATER, 0, v, p) for v, p in ((1, NEVER), (low, 0))),
        Change(ADD, 0, 1, NEVER),
        Change(ADD, 0, MORE, 0),
        Change(JOIN, 0, 1),
        Change(JOIN, 0, MORE),
    ]


PAIR = (
    (STOP, STOP),
    (BRAKE, SPEED),
    (BRAKE, BRAKE),
    (BRAKE, ADD),
    (BRAKE, JOIN),
    (STOP, SPEED),
    (SPEED, SPEED),
    (SPEED, STOP),
    (SPEED, SECTION),
    (SPEED, LATER),
    (LATER, SPEED),
    (LATER, STOP),
    (ADD, STOP),
    (JOIN, STOP),
    (JOIN, SPEED),
    (JOIN, JOIN),
    (SECTION, JOIN),
)
"""A BRAKE that something follows is a stop that is given up, or is followed by it at the rest."""


def steps_of(path: Path) -> list[int]:
    """When the path is at whole steps of its longest axis: ticks, scaled by 2^ROOT_BITS."""
    times = []
    for leg in path.legs:
        length = path.vectors[leg.vector].length
        times += [leg.pulse_time(length, length, k) for k in leg.pulses(length, length)]
    return times


def moments(path: Path, after: int = 0) -> list[int]:
    """Return the ticks at which something may happen: at, beside and between the steps."""
    ticks = [0, *((time + (1 << ROOT_BITS - 1)) >> ROOT_BITS for time in steps_of(path))]
    between = [(a + b) // 2 for a, b in pairwise(ticks)]
    beside = (tick + offset for tick, offset in product(ticks, (-1, 0, 1)))
    return sorted({tick for tick in (*beside, *between) if tick > after})


@dataclass(frozen=True)
class Trial:
    """A case with its changes, and what it was before the last of them."""

    case: Case
    path: Path
    changes: int
    """So many had taken effect."""


def with_change(trial: Trial, change: Change) -> Case:
    """Add a change; in the end a path that was stopped goes on."""
    case = trial.case
    before = tuple(made for made in case.changes if made.kind != GO)
    return replace(
        case,
        changes=(*before, change, Change(GO, change.tick, 7)),
        epoch=epoch(case.vectors, case.changes, change),
        ahead=(0, 84_000, AHEAD)[change.tick % 3],
    )


def undisturbed(case: Case) -> Trial:
    """Return the trial of a chain to which nothing has happened."""
    (made,) = run([case])
    return Trial(case, ideal(case, made), 0)


def assert_takes_effect(trial: Trial, change: Change, made: list[Made]) -> None:
    """A change takes effect if, since it last left a stand, a step before the rest is yet to come.

    In a cruise it may take effect after the last step. Vectors that join need one that has not been
    laid, and so say nothing.
    """
    done = len(made) - trial.changes
    if change.kind == JOIN:
        return
    begin = trial.path.begin_tick
    steps = [tick for time in steps_of(trial.path) if (tick := time >> ROOT_BITS) >= begin]
    if steps and trial.path.rest[1] == 0:
        steps.pop()
    if steps and change.tick < steps[-1]:
        assert done == 1, "that it takes effect"
    if change.tick > trial.path.legs[-1].end_time >> ROOT_BITS:
        assert done == 0, "that nothing happens after the rest"


def assert_dir_is_kept(case: Case, made: Run) -> None:
    """An axis that turns leaves DIR its time; at a start from a stand with S that is the caller's.

    The times are rounded at both ends.
    """
    least = case.turn_us * TICKS_PER_US - 1
    starts = [at.start for at in made.changes] if case.start_speed else []
    for axis, train in enumerate(made.trains):
        for a, b in pairwise(int(word) for word in train):
            stood = any(abs(a) <= start < abs(b) for start in starts)
            if (a > 0) != (b > 0) and not stood:
                assert abs(b) - abs(a) >= least, f"axis {axis} turns between {a} and {b}"


def assert_ends(case: Case, path: Path, made: Run) -> None:
    """The axes stand where the path rests: the pulses of all vectors before, and a part of one."""
    vector, place = path.rest
    for axis, train in enumerate(made.trains):
        end = sum(v.steps[axis] for v in case.vectors[:vector])
        if place != 0:
            own = case.vectors[vector]
            part = int(place * abs(own.steps[axis]) / own.length)
            end += part if own.steps[axis] > 0 else -part
        assert sum(1 if int(word) > 0 else -1 for word in train) == end, f"axis {axis}"


def assert_all_agree(trials: Iterable[tuple[Trial, Change]]) -> list[Trial]:
    """Run each trial with one change more; return what they are then."""
    asked = list(trials)
    cases = [with_change(trial, change) for trial, change in asked]
    after, worst, effects = [], 0.0, 0
    for (trial, change), case, made in zip(asked, cases, run(cases), strict=True):
        try:
            made_it = [at for at in made.changes if at.change.kind != GO]
            assert_takes_effect(trial, change, made_it)
            path = ideal(case, made)
            found = deviation(case, made)
            assert found.ticks <= GOAL_TICKS, f"axis {found.axis}, pulse {found.pulse}"
            assert_dir_is_kept(case, made)
            assert_ends(case, path, made)
        except AssertionError as error:
            raise AssertionError(f"{error}\n{case.line}") from error
        worst = max(worst, found.ticks)
        effects += len(made_it) > trial.changes
        after.append(Trial(case, ideal(case, replace(made, changes=made_it)), len(made_it)))
    print(f"{len(after)} runs, {effects} took effect, worst {worst:.3f} ticks")
    assert effects > len(after) // 4
    return after


def some(trials: Iterable[tuple[Trial, Change]], most: int, of: str) -> list[tuple[Trial, Change]]:
    """Return at most so many of them, others in each run of the tests."""
    every = list(trials)
    return random.Random(f"{SEED} {of}").sample(every, min(most, len(every)))


@pytest.mark.parametrize("name", CHAINS)
def test_anything_at_every_pulse_keeps_all_pulses_on_their_ticks(name: str) -> None:
    trial = undisturbed(CHAINS[name])
    changes = product(moments(trial.path), kinds_of(trial.case))
    every = ((trial, replace(change, tick=tick)) for tick, change in changes)
    assert_all_agree(some(every, SINGLES, name))


def seconds(first: Iterable[Trial]) -> Iterator[tuple[Trial, Change]]:
    """Return what may happen after the first change, at any moment after it."""
    for trial in first:
        braked = trial.case.changes[0]
        case = trial.case
        kinds = [b for a, b in PAIR if a == braked.kind]
        choice = [change for change in kinds_of(case) if change.kind in kinds]
        for tick, change in product(moments(trial.path, braked.tick), choice):
            yield trial, replace(change, tick=tick)


@pytest.mark.parametrize("name", BRIEF)
def test_any_two_at_any_pulses_keep_all_pulses_on_their_ticks(name: str) -> None:
    trial = undisturbed(BRIEF[name])
    changes = product(moments(trial.path), kinds_of(trial.case))
    every = ((trial, replace(change, tick=tick)) for tick, change in changes)
    first = assert_all_agree(some(every, PAIRS, f"{name}, first"))
    assert_all_agree(some(seconds(first), PAIRS, name))
