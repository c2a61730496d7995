"""Tests of the exact reference: the curves of moves as they are planned."""

from __future__ import annotations

import random
from decimal import Decimal, localcontext
from itertools import accumulate, pairwise

import pytest
from exact import Fraction
from other_ways import (
    assert_decimal_agrees,
    assert_walk_agrees,
    corners_of,
    random_sections,
    sample,
    walk,
)
from reference import TICK_HZ, Section, endless, limit_run, plan, single

TINY = Fraction(1, 1 << 40)
"""The promised accuracy, in ticks."""

MANUAL = [
    Section(2000, 500, 2000),
    Section(2000, 2000, 2000),
    Section(5000, 500, 2000),
    Section(5000, 3000, 1000),
    Section(2000, 1500, 1000),
    Section(2000, 500, 1000),
]
"""The compound move of the manual's ninth example, with S100."""

LIMITS = [
    (1, 16000, 1, 16_000_000),
    (1, 16000, 60_000, 16_000_000),
    (2000, 16000, 1, 16_000_000),
    (1999, 2000, 1, 16_000_000),
    (1, 1, 1, 16_000_000),
    (1, 16000, 60_000, 1),
    (2000, 1, 60_000, 2),
    (100, 1000, 2000, 7),
]
"""Corners of the ranges: S, V, A, N."""


# --- single moves -------------------------------------------------------------------


def test_constant_speed_gives_equal_intervals() -> None:
    curve = single(1000, start_speed=500, speed=100, accel=2000)
    for k in (1, 2, 999, 1000):
        assert abs(curve.tick(k) - k * 840_000) < TINY
    assert curve.last == 1000


def test_a_ramp_reaches_its_top_after_the_way_of_the_formula() -> None:
    curve = single(5000, start_speed=100, speed=1000, accel=2000)
    assert corners_of(curve) == [
        (0, 100.0),
        (Fraction(495, 2), 1000.0),
        (5000 - Fraction(495, 2), 1000.0),
        (5000, 100.0),
    ]
    seconds = 2 * Fraction(900, 2000) + Fraction(4505, 1000)
    assert abs(curve.tick(5000) - seconds * TICK_HZ) < TINY


def test_ramps_that_meet_peak_in_the_middle() -> None:
    curve = single(100, start_speed=100, speed=1000, accel=2000)
    assert [x for x, _ in curve.corners()] == [0, 50, 100]
    assert curve.speed_squared(50) == 100**2 + 2000 * 100


def test_a_move_of_one_step_rises_and_falls_within_it() -> None:
    curve = single(1, start_speed=100, speed=1000, accel=2000)
    peak = (100**2 + 2000 * 1) ** 0.5
    seconds = 2 * (peak - 100) / 2000
    assert float(curve.tick(1)) == pytest.approx(seconds * TICK_HZ, rel=1e-12)


@pytest.mark.parametrize(("s", "v", "a", "n"), LIMITS)
def test_a_single_move_reads_the_same_backward(s: int, v: int, a: int, n: int) -> None:
    curve = single(n, s, v, a)
    end = curve.tick(n)
    for k in sample(n):
        assert abs(curve.tick(k) + curve.tick(n - k) - end) < TINY


@pytest.mark.parametrize(("s", "v", "a", "n"), LIMITS)
def test_ticks_agree_with_decimals_over_the_whole_range(s: int, v: int, a: int, n: int) -> None:
    assert_decimal_agrees(single(n, s, v, a), sample(n))


def test_intervals_on_a_ramp_add_up_by_the_mean_of_the_speeds() -> None:
    curve = single(4000, start_speed=3, speed=4000, accel=700)
    with localcontext() as context:
        context.prec = 60
        speeds = [Decimal(9 + 2 * 700 * k).sqrt() for k in range(2001)]
        ticks = accumulate(TICK_HZ * 2 / (v + w) for v, w in pairwise(speeds))
        for k, due in enumerate(ticks, start=1):
            tick = curve.tick(k)
            exact = Decimal(tick.numerator) / Decimal(tick.denominator)
            assert abs(exact - due) < Decimal(2) ** -60


def test_the_tick_rate_is_a_factor() -> None:
    slow = single(300, 100, 1000, 2000, tick_hz=1_000_000)
    fast = single(300, 100, 1000, 2000, tick_hz=84_000_000)
    for k in range(1, 301):
        assert abs(84 * slow.tick(k) - fast.tick(k)) < TINY


def test_nearest_ticks_are_within_half_a_tick() -> None:
    curve = single(300, 100, 1000, 2000)
    for k, tick in enumerate(curve.nearest_ticks(range(1, 301)), start=1):
        assert abs(tick - curve.tick(k)) <= Fraction(1, 2)


def test_pulses_before_a_tick_are_those_due_earlier() -> None:
    curve = single(300, start_speed=100, speed=100, accel=1)
    assert curve.pulses_before(0) == 0
    assert curve.pulses_before(840_000) == 0
    assert curve.pulses_before(840_001) == 1
    assert curve.pulses_before(TICK_HZ * 100) == 300


@pytest.mark.parametrize("k", [-1, 11])
def test_a_pulse_that_does_not_exist_is_refused(k: int) -> None:
    with pytest.raises(ValueError, match="no pulse"):
        single(10, 100, 1000, 2000).tick(k)


def test_a_move_of_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="start at 1"):
        Section(0, 1000, 2000)
    with pytest.raises(ValueError, match="has a section"):
        plan([], 100)


# --- runs without end ---------------------------------------------------------------


def test_an_endless_run_ramps_up_and_keeps_its_speed() -> None:
    curve = endless(start_speed=100, speed=1000, accel=2000)
    assert curve.last is None
    assert corners_of(curve) == [(0, 100.0), (Fraction(495, 2), 1000.0)]
    assert curve.tick(10**9 + 1) - curve.tick(10**9) == 84_000
    assert curve.pulses_before(TICK_HZ) == 797


def test_a_limit_run_keeps_the_start_speed_whatever_is_asked() -> None:
    curve = limit_run(200)
    assert curve.tick(1000) == 420_000_000
    assert curve.speed_changed_at(5, 4000) == curve
    assert curve.stopped_at(5).last == 5


# --- compound moves -----------------------------------------------------------------


def test_the_manual_example_peaks_at_2500_in_its_fourth_section() -> None:
    corners = corners_of(plan(MANUAL, 100))
    fourth = [(x, v) for x, v in corners if 9000 <= x <= 14_000]
    assert fourth == [(9000, 500.0), (12_000, 2500.0), (14_000, 1500.0)]


def test_the_manual_example_has_the_borders_of_its_sections() -> None:
    curve = plan(MANUAL, 100)
    ends = [0, *accumulate(s.steps for s in MANUAL)]
    borders = [float(curve.speed_squared(k)) ** 0.5 for k in ends]
    assert borders == [100, 500, 500, 500, 1500, 500, 100]


def test_a_move_cut_into_equal_sections_is_the_same_move() -> None:
    whole = single(6000, 100, 3000, 2000)
    parts = plan([Section(n, 3000, 2000) for n in (1, 2999, 1000, 1999, 1)], 100)
    for k in range(1, 6001):
        assert abs(whole.tick(k) - parts.tick(k)) < TINY


def test_border_speeds_are_lowered_by_a_short_section_after() -> None:
    curve = plan([Section(5000, 4000, 1000), Section(10, 4000, 500)], 100)
    assert curve.speed_squared(5000) == 100**2 + 2 * 500 * 10


def test_a_first_section_too_short_to_brake_lowers_the_first_speed() -> None:
    curve = plan([Section(2, 300, 500), Section(9, 20, 500)], 100)
    assert curve.speed_squared(0) == 20**2 + 2 * 500 * 2
    assert curve.speed_squared(2) == 20**2


def test_a_last_section_too_short_to_speed_up_ends_below_the_start_speed() -> None:
    curve = plan([Section(9, 20, 500), Section(2, 300, 500)], 100)
    assert curve.speed_squared(11) == 20**2 + 2 * 500 * 2


def test_a_section_slower_than_the_start_speed_is_entered_at_its_own() -> None:
    sections = [Section(50, 300, 500), Section(9, 20, 500), Section(50, 300, 500)]
    curve = plan(sections, 100)
    assert curve.speed_squared(0) == 100**2
    assert curve.speed_squared(50) == 20**2
    assert curve.speed_squared(59) == 20**2
    assert curve.speed_squared(60) == 20**2 + 1000


@pytest.mark.parametrize("seed", range(40))
def test_a_compound_move_is_the_fastest_that_the_limits_allow(seed: int) -> None:
    rng = random.Random(seed)
    sections, start = random_sections(rng), rng.choice([1, 50, 100, 900])
    curve = plan(sections, start)
    cells = [s for s in sections for _ in range(s.steps)]
    ends = min(start, sections[-1].speed) ** 2
    tops = [min(a.speed, b.speed) ** 2 for a, b in pairwise(cells)]
    fastest = [min(start, cells[0].speed) ** 2, *tops, ends]
    for k, cell in enumerate(cells):
        fastest[k + 1] = min(fastest[k + 1], fastest[k] + 2 * cell.accel)
    for k in reversed(range(len(cells))):
        fastest[k] = min(fastest[k], fastest[k + 1] + 2 * cells[k].accel)
    assert [curve.speed_squared(k) for k in range(len(fastest))] == fastest


@pytest.mark.parametrize("seed", range(10))
def test_a_compound_move_agrees_with_a_walk_through_time(seed: int) -> None:
    rng = random.Random(seed)
    sections = [
        Section(rng.randint(20, 300), rng.randint(100, 900), rng.randint(300, 3000))
        for _ in range(3)
    ]
    assert_walk_agrees(plan(sections, 80), walk(sections, 80, dt=5e-5))


@pytest.mark.parametrize("seed", range(20))
def test_a_random_compound_move_agrees_with_decimals(seed: int) -> None:
    rng = random.Random(seed)
    sections = random_sections(rng)
    last = sum(s.steps for s in sections)
    assert_decimal_agrees(plan(sections, rng.randint(1, 2000)), sample(last))


def test_the_longest_compound_move_agrees_with_decimals() -> None:
    curve = plan([Section(16_000_000, 16_000, 1)] * 10, 1)
    assert_decimal_agrees(curve, sample(160_000_000))
