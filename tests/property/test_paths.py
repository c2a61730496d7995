"""Random chains of vectors, and the corner cases of paths, against the exact reference.

`RKM04_LONG` tries ten thousand chains in place of a sample, and prints how far off each was.
"""

from __future__ import annotations

import os
import random
from dataclasses import replace
from itertools import pairwise

import pytest
from chance import SEED
from exact import Fraction
from path_chains import ACCEL_MAX, SPEED_MAX, any_chain, corners, long_corners, vector
from path_probe import NEVER, SPEED, STOP, Case, Change, deviation, ideal, run

GOAL_TICKS = 0.65
LONG = bool(os.environ.get("RKM04_LONG"))
CHAINS = 10_000 if LONG else 400
BATCH = 40

SHORT = (
    vector((60, 41, 0, -7), 3000, 60_000),
    vector((-12, 30, 25, 30), 5000, 90_000),
    vector((1, -1, 1, 0), 2000, 1000),
    vector((25, 0, -40, 13), 900, 40_000),
)
"""Ramps that meet, axes that rest, turn and begin, a vector of one step."""


def assert_exact(cases: list[Case]) -> float:
    """Run cases; every pulse must be there, on its tick; returns the worst deviation."""
    worst = []
    for case, made in zip(cases, run(cases), strict=True):
        found = deviation(case, made)
        assert found.ticks <= GOAL_TICKS, f"axis {found.axis}, pulse {found.pulse}: {case.line}"
        worst.append(found.ticks)
    if LONG:
        print(*(f"{ticks:.3f}" for ticks in sorted(worst)))
    return max(worst)


@pytest.mark.parametrize("batch", range(CHAINS // BATCH))
def test_every_pulse_of_any_chain_is_on_its_tick(batch: int) -> None:
    chains = range(batch * BATCH, (batch + 1) * BATCH)
    worst = assert_exact([any_chain(random.Random(f"{SEED} {chain}")) for chain in chains])
    assert worst > 0.4, "that the reference is asked at all"


def test_every_pulse_of_the_corner_cases_is_on_its_tick() -> None:
    assert_exact(corners())


def test_pulses_do_not_drift_in_millions_of_steps_and_in_hours() -> None:
    assert_exact(long_corners()[:: 1 if LONG else 3])


def test_of_what_is_told_in_part_nothing_is_another_pulse() -> None:
    """The probe jumps in cruises of which not all pulses are told."""
    case = corners()[0]
    (whole,) = run([case])
    (part,) = run([replace(case, stride=97)])
    for all_ticks, some in zip(whole.trains, part.trains, strict=True):
        pairs = [word.split(":") for word in some]
        assert [all_ticks[int(ordinal) - 1] for ordinal, _ in pairs] == [t for _, t in pairs]
        assert int(pairs[-1][0]) == len(all_ticks)


def test_an_axis_that_turns_at_a_stand_is_late_enough_with_any_acceleration() -> None:
    """With 500 us the speed at the border is 0, and the way from there in that time one step."""
    there, back = (100, 100, 0, 0), (-100, 99, 0, 0)
    case = Case(
        (vector(there, SPEED_MAX, ACCEL_MAX), vector(back, SPEED_MAX, ACCEL_MAX)), turn_us=500
    )
    (made,) = run([case])
    ticks = [int(word) for word in made.trains[0]]
    assert -ticks[100] - ticks[99] == 500 * 84
    assert_exact([case])


def moments() -> list[int]:
    """Return a moment before each pulse of SHORT."""
    case = Case(SHORT)
    (made,) = run([case])
    ticks = sorted({abs(int(word)) for train in made.trains for word in train})
    return [1, *((a + b) // 2 for a, b in pairwise(ticks))]


def test_a_stop_at_any_moment_rests_where_it_must_and_goes_on_from_there() -> None:
    ticks = moments()[:: 1 if LONG else 4]
    assert_exact([Case(SHORT, changes=(Change(STOP, tick, tick % 7),)) for tick in ticks])


def test_a_change_of_speed_at_any_moment_keeps_every_pulse_on_its_tick() -> None:
    ticks = moments()[:: 1 if LONG else 4]
    speeds = (1, 25_600, 51_200_000)
    assert_exact([Case(SHORT, changes=(Change(SPEED, tick, speeds[tick % 3]),)) for tick in ticks])


def test_a_path_that_is_stopped_a_hundred_times_ends_where_one_does_that_was_not() -> None:
    steps = (2000, 1999, -3, 1000)
    stops = tuple(Change(STOP, 1_000_000 * i, i % 3, (NEVER, 0)[i % 2]) for i in range(1, 101))
    case = Case((vector(steps, 5000, 100_000),), changes=stops)
    (made,) = run([case])
    assert len(made.changes) == len(stops)
    assert [len(train) for train in made.trains] == [abs(d) for d in steps]
    assert_exact([case])


def test_a_crawling_path_is_changed_between_its_pulses() -> None:
    """At 0.1 steps/s the next pulse may be ten seconds away; patience is 1 ms."""
    crawl = Case(
        (vector((5, 3, 0, 0), 0.1, 100),), changes=(Change(SPEED, 2_000_000_000, 256_000, 84_000),)
    )
    (made,) = run([crawl])
    (change,) = made.changes
    assert change.place.denominator > 1
    assert 0 <= change.tick - 2_000_000_000 <= 84_000
    assert_exact([crawl])
    path = ideal(crawl, made)
    assert path.rest == (1, Fraction(0))
