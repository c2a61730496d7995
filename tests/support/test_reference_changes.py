"""Tests of the exact reference: what stops and speed changes make of a curve."""

from __future__ import annotations

import random
from itertools import accumulate, pairwise

import pytest
from exact import Fraction
from other_ways import assert_walk_agrees, corners_of, random_sections, sample, walk
from reference import ENDLESS, Curve, Leg, Section, endless, plan, single

# --- stops --------------------------------------------------------------------------


def test_a_stop_brakes_to_the_start_speed_over_the_way_of_the_formula() -> None:
    stopped = single(5000, 100, 1000, 2000).stopped_at(1000)
    assert stopped.last == 1247
    assert corners_of(stopped)[-1] == (Fraction(2495, 2), 100.0)
    for k in range(1000, 1248):
        assert stopped.speed_squared(k) == 1000**2 - 4000 * (k - 1000)


def test_a_stop_on_the_way_up_brakes_from_the_speed_reached() -> None:
    stopped = single(5000, 100, 1000, 2000).stopped_at(30)
    assert stopped.last == 60
    assert stopped.speed_squared(30) == 100**2 + 4000 * 30


def test_a_stop_at_the_start_speed_or_below_ends_with_its_pulse() -> None:
    assert single(500, 100, 100, 2000).stopped_at(7).last == 7
    assert single(500, 100, 40, 2000).stopped_at(7).last == 7


def test_a_stop_on_the_final_ramp_changes_nothing() -> None:
    curve = single(5000, 100, 1000, 2000)
    for k in range(4753, 5001):
        assert curve.stopped_at(k).legs == curve.legs


def test_a_stop_on_a_final_ramp_through_two_sections_changes_nothing() -> None:
    curve = plan([Section(900, 900, 800), Section(40, 900, 3000)], 100)
    for k in range(700, 941):
        assert curve.stopped_at(k).legs == curve.legs


def test_a_stop_goes_on_with_the_acceleration_of_the_next_section() -> None:
    curve = plan([Section(500, 1000, 1000), Section(5000, 1000, 4000)], 100)
    stopped = curve.stopped_at(450)
    at_border = stopped.speed_squared(450) - 2000 * 50
    assert stopped.speed_squared(500) == at_border
    assert stopped.speed_squared(501) == at_border - 8000


def test_a_stop_at_a_border_has_the_acceleration_of_the_section_after() -> None:
    curve = plan([Section(800, 1000, 1000), Section(5000, 1000, 4000)], 100)
    stopped = curve.stopped_at(800)
    assert stopped.speed_squared(801) == curve.speed_squared(800) - 8000


def test_an_endless_run_ends_by_a_stop() -> None:
    assert endless(100, 1000, 2000).stopped_at(1_000_000).last == 1_000_247


def test_a_second_stop_changes_nothing() -> None:
    stopped = single(5000, 100, 1000, 2000).stopped_at(1000)
    assert all(stopped.stopped_at(k).legs == stopped.legs for k in range(1000, 1248))


def test_a_speed_change_after_a_stop_changes_nothing() -> None:
    stopped = single(5000, 100, 1000, 2000).stopped_at(1000)
    assert stopped.speed_changed_at(1001, 5000) == stopped


@pytest.mark.parametrize("seed", range(30))
def test_a_stop_at_any_pulse_keeps_the_past_and_the_target(seed: int) -> None:
    rng = random.Random(seed)
    sections, start = random_sections(rng, most=4), rng.choice([1, 50, 100, 900])
    curve = plan(sections, start)
    last = sum(s.steps for s in sections)
    for k in sample(last):
        stopped = curve.stopped_at(k)
        assert stopped.last is not None
        assert k <= stopped.last <= last
        assert stopped.ticks(range(k + 1)) == curve.ticks(range(k + 1))
        assert stopped.tick(stopped.last) >= curve.tick(stopped.last)
        assert stopped.speed_squared(stopped.last) <= curve.speed_squared(stopped.last)


# --- speed changes ------------------------------------------------------------------


def test_a_change_ramps_to_the_new_speed_and_ends_as_usual() -> None:
    changed = single(5000, 100, 1000, 2000).speed_changed_at(1000, 2000)
    assert corners_of(changed) == [
        (0, 100.0),
        (Fraction(495, 2), 1000.0),
        (1000, 1000.0),
        (1750, 2000.0),
        (Fraction(8005, 2), 2000.0),
        (5000, 100.0),
    ]


def test_a_change_down_brakes_to_the_new_speed() -> None:
    changed = single(5000, 100, 1000, 2000).speed_changed_at(1000, 500)
    assert (Fraction(2375, 2), 500.0) in corners_of(changed)
    assert corners_of(changed)[-2:] == [(4940, 500.0), (5000, 100.0)]


def test_a_change_to_the_present_speed_changes_nothing() -> None:
    curve = single(5000, 100, 1000, 2000)
    assert all(curve.speed_changed_at(k, 1000).legs == curve.legs for k in range(1, 5001))


def test_a_change_up_on_the_final_ramp_changes_nothing() -> None:
    curve = single(5000, 100, 1000, 2000)
    for k in range(4753, 5001):
        assert curve.speed_changed_at(k, 9000).legs == curve.legs


def test_a_change_with_too_little_way_peaks_where_the_ramps_meet() -> None:
    changed = single(5000, 100, 1000, 2000).speed_changed_at(4700, 9000)
    peak = (1000**2 + 100**2 + 4000 * 300) / 2
    meet = 4700 + Fraction(1_105_000 - 1_000_000, 4000)
    assert (meet, peak**0.5) in corners_of(changed)


def test_speeds_up_to_the_start_speed_are_taken_at_once() -> None:
    changed = single(500, 100, 20, 2000).speed_changed_at(50, 80)
    assert corners_of(changed) == [(0, 20.0), (50, 20.0), (50, 80.0), (500, 80.0)]
    lower = single(500, 100, 90, 2000).speed_changed_at(50, 10)
    assert corners_of(lower) == [(0, 90.0), (50, 90.0), (50, 10.0), (500, 10.0)]


def test_a_change_from_below_the_start_speed_ramps_from_the_start_speed() -> None:
    changed = single(500, 100, 20, 2000).speed_changed_at(50, 300)
    assert corners_of(changed)[1:4] == [(50, 20.0), (50, 100.0), (70, 300.0)]
    assert corners_of(changed)[-2:] == [(480, 300.0), (500, 100.0)]


def test_a_change_below_the_start_speed_brakes_to_it_and_drops() -> None:
    changed = single(5000, 100, 1000, 2000).speed_changed_at(1000, 30)
    knee = Fraction(2495, 2)
    assert corners_of(changed)[2:] == [
        (1000, 1000.0),
        (knee, 100.0),
        (knee, 30.0),
        (5000, 30.0),
    ]
    assert changed.last == 5000


def test_a_change_holds_for_the_current_section_only() -> None:
    sections = [Section(1000, 500, 2000), Section(1000, 800, 2000)]
    changed = plan(sections, 100).speed_changed_at(300, 200)
    assert changed.speed_squared(700) == 200**2
    assert changed.speed_squared(1000) == 200**2
    assert changed.speed_squared(1500) == 800**2


def test_a_change_at_a_border_changes_the_section_after_it() -> None:
    sections = [Section(1000, 500, 2000), Section(1000, 800, 2000)]
    changed = plan(sections, 100).speed_changed_at(1000, 600)
    assert changed.speed_squared(1000) == 500**2
    assert changed.speed_squared(1500) == 600**2


def test_a_change_at_a_border_takes_speeds_up_to_the_start_speed_at_once() -> None:
    sections = [Section(10, 20, 500), Section(100, 50, 500)]
    changed = plan(sections, 100).speed_changed_at(10, 80)
    assert changed.speed_squared(10) == 80**2


def test_a_border_that_cannot_be_braked_to_is_passed_at_what_braking_reaches() -> None:
    sections = [Section(1000, 1000, 500), Section(2000, 1000, 500)]
    curve = plan(sections, 100)
    changed = curve.speed_changed_at(990, 150)
    reached = curve.speed_squared(990) - 1000 * 10
    assert changed.speed_squared(1000) == reached
    assert changed.speed_squared(1001) == reached + 1000


def test_braking_that_meets_the_start_speed_at_the_border_drops_there() -> None:
    sections = [Section(500, 200, 1000), Section(500, 200, 1000)]
    changed = plan(sections, 100).speed_changed_at(485, 30)
    assert changed.speed_squared(499) == 100**2 + 2000
    assert changed.speed_squared(500) == 30**2


def test_a_jump_up_is_no_higher_than_can_be_braked_at_the_border() -> None:
    sections = [Section(100, 20, 500), Section(100, 5, 500)]
    changed = plan(sections, 100).speed_changed_at(97, 80)
    assert changed.speed_squared(97) == 5**2 + 1000 * 3
    assert changed.speed_squared(100) == 5**2


def test_a_stop_after_a_change_brakes_from_the_new_speed() -> None:
    curve = single(5000, 100, 1000, 2000).speed_changed_at(1000, 2000)
    assert curve.stopped_at(1750).corners()[-1] == (1750 + Fraction(1995, 2), 100.0)


@pytest.mark.parametrize("speed", [150, 400, 900])
def test_a_change_agrees_with_a_walk_through_time(speed: int) -> None:
    sections = [Section(300, 500, 1500), Section(300, 700, 900)]
    curve = plan(sections, 80)
    changed = curve.speed_changed_at(100, speed)
    start = (100.0, float(curve.speed_squared(100)) ** 0.5)
    walked = walk([Section(300, speed, 1500), sections[1]], 80, 5e-5, start)
    assert_walk_agrees(changed, walked, first=101)


def assert_lawful(before: Curve, after: Curve, k: int) -> None:
    """Check what must hold of every curve after a change at pulse k.

    Above both the speed in force and S it brakes as hard as it can; speeds change
    with the acceleration in force except by jumps up to S; the target is met.
    """
    slow, last = after.start_speed**2, after.last
    assert last == before.last
    assert after.ticks(range(k + 1)) == before.ticks(range(k + 1))
    for leg in after.legs:
        inside = after.sections[section_of(after, leg)]
        assert abs(leg.a) in (0, inside.accel)
        if leg.x0 >= k and leg.w0 > max(slow, inside.speed**2):
            assert leg.a == -inside.accel
    for one, two in pairwise(after.legs):
        assert one.x1 == two.x0
        assert one.w1 == two.w0 or max(one.w1, two.w0) <= slow
    end = min(after.start_speed, after.sections[-1].speed) ** 2
    assert after.legs[-1].x1 == last
    assert after.legs[-1].w1 <= end or after.legs[-1].w1 == slow


def section_of(curve: Curve, leg: Leg) -> int:
    """Return the section in which a leg begins."""
    ends = list(accumulate(s.steps for s in curve.sections))
    return next(i for i, end in enumerate(ends) if leg.x0 < end)


@pytest.mark.parametrize("seed", range(150))
def test_changes_in_a_row_at_any_pulse_are_lawful(seed: int) -> None:
    rng = random.Random(seed)
    curve = plan(random_sections(rng, most=4), rng.choice([1, 50, 100, 900]))
    assert curve.last is not None
    pulses = sorted(rng.randint(1, curve.last) for _ in range(6))
    for k in pulses:
        speed = rng.choice([1, 30, 100, rng.randint(1, 4000), 16_000])
        changed = curve.speed_changed_at(k, speed)
        assert_lawful(curve, changed, k)
        stopped = changed.stopped_at(k)
        assert stopped.last is not None
        assert k <= stopped.last <= curve.last
        curve = changed


def test_a_change_of_an_endless_run_is_kept_without_end() -> None:
    curve = endless(100, 1000, 2000).speed_changed_at(500, 2000)
    assert curve.last is None
    assert curve.speed_squared(ENDLESS // 4) == 2000**2
