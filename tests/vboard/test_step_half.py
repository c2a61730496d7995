"""Pulses of half a period: each is high until the middle before the next one; none moves for it."""

from __future__ import annotations

import random
from dataclasses import replace
from itertools import accumulate, pairwise

import pytest
from chance import SEED
from step_acts import (
    FAST_BUS,
    LONG,
    MOTORS,
    ODD,
    READY,
    READY_SEGMENTS,
    SHORT,
    WIDTH,
    Acts,
    MakeActs,
    Shown,
)
from step_trials import Train, assert_turns

TICKS_PER_US = 84
WIDEST = 10 * TICKS_PER_US
BEGIN = READY + 20_000
HALTS = Train(trials=1, pace_ticks=5250, pulses=3, halt_ticks=16_000)
FAST = Train(trials=1, pace_ticks=440, pulses=60, halt_ticks=30_000)
RIGS = [(SHORT, []), (SHORT, ODD), (SHORT, FAST_BUS), (LONG, [])]


def wide(name: str, ticks: int) -> int:
    return max(WIDTH[name], min(ticks, WIDEST))


def widths(shown: Shown, motor: int) -> list[int]:
    return [fall - rise for rise, fall in zip(shown.rises[motor], shown.falls[motor], strict=True)]


def assert_half(
    name: str, shown: Shown, motor: int, ticks: list[int], turns: tuple[int, ...] = ()
) -> None:
    """But for the first pulse, that after a turn, and the last, which none follows."""
    expected = [wide(name, (b - a) // 2) for a, b in pairwise(ticks)] + [WIDTH[name]]
    seen = widths(shown, motor)
    for number in (0, *turns):
        assert seen[number] in (WIDTH[name], expected[number])
        expected[number] = seen[number]
    assert shown.rises[motor] == ticks
    assert seen == expected


@pytest.mark.parametrize(("name", "options"), RIGS)
@pytest.mark.parametrize("pace", [420, 1000, 1680, 1700, 8064, 20_000, 100_001, 3_000_000])
def test_pulses_of_a_steady_train_are_half_a_period_wide(make_acts: MakeActs, name, options, pace):
    acts: Acts = make_acts(name, half_period=True)
    ticks = [acts.move_steady(motor, BEGIN + 37 * motor, pace, 40) for motor in MOTORS]
    acts.rest()

    shown = acts.show(*options)

    assert shown.late == 0
    for motor in MOTORS:
        assert_half(name, shown, motor, ticks[motor])


@pytest.mark.parametrize(("name", "options"), RIGS)
def test_widths_follow_intervals_that_jump(make_acts: MakeActs, name, options):
    """By up to a thousand times from one pulse to the next, as at borders of vectors."""
    chance = random.Random(SEED)
    least = 2 * WIDTH[name] + 16
    ticks = list(
        accumulate((least + round(10 ** chance.uniform(0, 5.5)) for _ in range(99)), initial=BEGIN)
    )
    acts: Acts = make_acts(name, half_period=True)
    acts.begin(0, BEGIN - 1000)
    for tick in ticks[:READY_SEGMENTS]:
        acts.push(0, tick)
    acts.run(0)
    for ahead, tick in zip(ticks, ticks[READY_SEGMENTS:], strict=False):
        acts.wait(ahead)
        acts.push(0, tick)
    acts.rest()

    shown = acts.show(*options)

    assert shown.late == 0
    assert_half(name, shown, 0, ticks)


@pytest.mark.parametrize("name", [SHORT, LONG])
@pytest.mark.parametrize("train", [replace(HALTS, trials=4000), replace(FAST, trials=1000)])
def test_pulses_that_are_taken_back_at_any_time_are_made_and_counted_or_neither(
    try_trains, name, train
):
    tried = try_trains(name, train, half_period=True)

    assert tried.counted == tried.shown
    assert tried.warnings == tried.late == 0
    made = sum(tried.counted) / (train.trials * train.pulses)
    assert 1 / 5 < made < 3 / 4
    assert tried.least_us("width_min") == pytest.approx(WIDTH[name] / TICKS_PER_US)


@pytest.mark.parametrize("name", [SHORT, LONG])
@pytest.mark.parametrize("pace", [20_000, 400_000])
def test_dir_turns_between_slow_pulses_laid_long_before(make_acts: MakeActs, name, pace):
    """Nearer to the first pulse than to the second, of which it is told when that is near."""
    acts: Acts = make_acts(name, half_period=True)
    ticks: list[int] = []
    acts.begin(0, BEGIN - 1000)
    for number in range(9):
        acts.turn(0, number % 2 != 0)
        ticks += acts.push_steady(0, BEGIN + 3 * number * pace, pace, 3)
    acts.run(0)
    acts.rest()

    shown = acts.show()

    assert_half(name, shown, 0, ticks, turns=tuple(range(3, 27, 3)))
    assert shown.positions[0] == 3
    assert_turns(shown, 0)
    held = [at - max(tick for tick in ticks if tick < at) for at, _ in shown.directions[0]]
    assert len(held) == 8
    assert max(held) < 1000
