"""Laws that hold between two paths, whatever their vectors: no reference has a part in them.

Mirrored axes, axes in another order, scaled steps and times, vectors in two parts; more vectors and
higher limits, which make nothing later; stops, which make nothing earlier; another time of the unit
and another horizon, which change nothing. `RKM04_LONG` tries more chains.
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import permutations

import pytest
from chance import SEED
from path_chains import SPEED_MAX, any_chain, any_size
from path_probe import ADD, JOIN, NEVER, STOP, Case, Change, run
from path_reference import SPEED_UNITS, Vector

LONG = bool(os.environ.get("RKM04_LONG"))
CHAINS = 600 if LONG else 40
NEAR_TICKS = 1
"""Two pulses that are due at the same time: each may be 0.65 ticks off."""

Trains = list[list[int]]


def trains(cases: Sequence[Case]) -> list[Trains]:
    """Run cases; returns the ticks of all pulses, negative for those backward."""
    return [[[int(word) for word in train] for train in made.trains] for made in run(cases)]


def chains(law: str, changes: int = 0) -> list[Case]:
    """Draw chains for a law: the same in a run of the tests."""
    rng = random.Random(f"{SEED} {law}")
    return [any_chain(rng, steps=400, changes=changes) for _ in range(CHAINS)]


def each(case: Case, change: Callable[[Vector], Vector]) -> Case:
    """Change each vector of a chain."""
    return replace(case, vectors=tuple(change(v) for v in case.vectors))


def plain(case: Case) -> Case:
    """Return a chain without turns, all of which is there at the start; speeds count steps."""

    def forward(v: Vector) -> Vector:
        x, y, z, w = map(abs, v.steps)
        return replace(v, steps=(x, y, z, w), extent2=0)

    return replace(each(case, forward), known=0)


def assert_near(case: Case, made: Trains, other: Trains, times: int = 1) -> None:
    """Of so many pulses one is where that of the other is."""
    for one, two in zip(made, other, strict=True):
        assert len(one) * times == len(two), case.line
        for a, b in zip(one, two[times - 1 :: times], strict=True):
            assert abs(a - b) <= NEAR_TICKS, f"{a} and {b}: {case.line}"


def assert_no_later(case: Case, made: Trains, other: Trains) -> None:
    """The pulses that both have come no later in the second."""
    for one, two in zip(made, other, strict=True):
        for a, b in zip(one, two, strict=False):
            assert abs(b) <= abs(a) + NEAR_TICKS, f"{a}, then {b}: {case.line}"


def test_axes_that_are_mirrored_make_the_same_pulses_the_other_way() -> None:
    cases = chains("mirror", changes=3)
    signs = [random.Random(f"{SEED} {i}").choices((1, -1), k=4) for i in range(len(cases))]

    def mirrored(case: Case, by: list[int]) -> Case:
        a, b, c, d = by
        return each(
            case,
            lambda v: replace(
                v, steps=(a * v.steps[0], b * v.steps[1], c * v.steps[2], d * v.steps[3])
            ),
        )

    others = trains([mirrored(case, by) for case, by in zip(cases, signs, strict=True)])
    for case, by, made, other in zip(cases, signs, trains(cases), others, strict=True):
        assert other == [
            [sign * tick for tick in train] for sign, train in zip(by, made, strict=True)
        ], case.line


def test_axes_in_another_order_make_the_same_pulses() -> None:
    cases = [each(case, lambda v: replace(v, extent2=0)) for case in chains("order", changes=3)]
    orders = random.Random(f"{SEED} orders").choices(list(permutations(range(4))), k=len(cases))

    def ordered(case: Case, by: tuple[int, ...]) -> Case:
        a, b, c, d = by
        return each(
            case,
            lambda v: replace(v, steps=(v.steps[a], v.steps[b], v.steps[c], v.steps[d])),
        )

    others = trains([ordered(case, by) for case, by in zip(cases, orders, strict=True)])
    for case, by, made, other in zip(cases, orders, trains(cases), others, strict=True):
        assert other == [made[axis] for axis in by], case.line


@pytest.mark.parametrize("times", [2, 3, 7])
def test_finer_steps_at_as_much_higher_speeds_change_no_time(times: int) -> None:
    def coarse(v: Vector) -> Vector:
        return replace(v, speed=min(v.speed, 20_000 * SPEED_UNITS), accel=min(v.accel, 10**8))

    def fine(v: Vector) -> Vector:
        a, b, c, d = (times * steps for steps in v.steps)
        limits = (times * v.speed, times * v.accel, min(times * v.border, 2**32 - 1))
        return Vector((a, b, c, d), *limits)

    cases = [each(plain(case), coarse) for case in chains("finer")]
    others = trains([each(case, fine) for case in cases])
    for case, made, other in zip(cases, trains(cases), others, strict=True):
        assert_near(case, made, other, times)


@pytest.mark.parametrize("times", [2, 5])
def test_speeds_so_many_times_and_accelerations_as_often_again_take_a_part_of_the_time(
    times: int,
) -> None:
    def slow(v: Vector) -> Vector:
        return replace(v, speed=min(v.speed, 40_000 * SPEED_UNITS), accel=min(v.accel, 10**7))

    def fast(v: Vector) -> Vector:
        border = min(times * v.border, 2**32 - 1)
        return replace(v, speed=times * v.speed, accel=times**2 * v.accel, border=border)

    cases = [each(plain(case), slow) for case in chains("faster")]
    others = trains([each(case, fast) for case in cases])
    for case, made, other in zip(cases, trains(cases), others, strict=True):
        for one, two in zip(made, other, strict=True):
            assert len(one) == len(two), case.line
            for a, b in zip(one, two, strict=True):
                assert abs(a - times * b) <= times * NEAR_TICKS, f"{a} and {b}: {case.line}"


def test_a_straight_way_in_two_vectors_is_one() -> None:
    rng = random.Random(f"{SEED} straight")
    whole, split = [], []
    for case in map(plain, chains("straight")):
        v = case.vectors[0]
        parts = (rng.randint(1, 40), rng.randint(1, 40))
        first, second, both = (
            replace(v, steps=(p * v.steps[0], p * v.steps[1], p * v.steps[2], p * v.steps[3]))
            for p in (*parts, sum(parts))
        )
        second = replace(second, border=2**32 - 1)
        whole.append(replace(case, vectors=(both, *case.vectors[1:5])))
        split.append(replace(case, vectors=(first, second, *case.vectors[1:5])))
    for case, made, other in zip(split, trains(whole), trains(split), strict=True):
        assert_near(case, made, other)


def test_a_vector_more_makes_nothing_later_and_the_sooner_it_comes_the_less() -> None:
    rng = random.Random(f"{SEED} more")
    for case in chains("more"):
        if len(case.vectors) == 1:
            continue
        known = len(case.vectors) - 1
        alone = replace(case, vectors=case.vectors[:known], known=0)
        (before,) = trains([alone])
        end = max(abs(train[-1]) for train in before if train)
        late, soon = sorted((rng.randrange(end), rng.randrange(end)), reverse=True)
        joined = [
            replace(case, known=known, changes=(Change(kind, tick, 1),))
            for kind, tick in ((ADD, late), (ADD, soon), (JOIN, late), (JOIN, soon))
        ]
        add_late, add_soon, join_late, join_soon = trains(joined)
        (there,) = trains([replace(case, known=0)])
        for slower, faster in (
            (before, add_late),
            (add_late, add_soon),
            (add_soon, there),
            (before, join_late),
            (join_late, join_soon),
            (join_soon, there),
        ):
            assert_no_later(case, slower, faster)


def test_higher_limits_make_nothing_later() -> None:
    rng = random.Random(f"{SEED} limits")

    def higher(v: Vector) -> Vector:
        speed, border = min(2 * v.speed, SPEED_MAX * SPEED_UNITS), any_size(rng, 2**32 - 1)
        return replace(v, speed=max(v.speed, speed), border=max(v.border, border))

    cases = [replace(case, known=0) for case in chains("limits")]
    others = trains([each(case, higher) for case in cases])
    for case, made, other in zip(cases, trains(cases), others, strict=True):
        assert [len(train) for train in made] == [len(train) for train in other]
        assert_no_later(case, made, other)


def test_a_stop_that_is_gone_on_from_loses_no_pulse_and_makes_none_earlier() -> None:
    rng = random.Random(f"{SEED} stops")
    cases = [replace(case, known=0) for case in chains("stops")]
    undisturbed = trains(cases)
    stopped = []
    for case, made in zip(cases, undisturbed, strict=True):
        ticks = sorted(rng.choice([abs(t) for train in made for t in train]) for _ in range(3))
        stops = (Change(STOP, tick, 0, rng.choice((NEVER, 0))) for tick in ticks)
        stopped.append(replace(case, changes=tuple(stops)))
    for case, made, other in zip(stopped, undisturbed, trains(stopped), strict=True):
        assert [len(train) for train in made] == [len(train) for train in other], case.line
        assert_no_later(case, other, made)


def test_neither_the_time_of_the_unit_nor_the_horizon_changes_a_tick() -> None:
    rng = random.Random(f"{SEED} time")
    cases = chains("time", changes=6)
    others = [
        replace(case, epoch=(rng.getrandbits(20) + 1 << 32) - rng.getrandbits(31), ahead=ahead)
        for case, ahead in zip(
            cases, rng.choices((0, 84_000, 84_000_000), k=len(cases)), strict=True
        )
    ]
    for case, made, other in zip(others, trains(cases), trains(others), strict=True):
        assert made == other, case.line
