"""The timers of the virtual board: edges at the exact tick, flags, modes."""

from __future__ import annotations

import pytest

PINS = "m1_step PA0\nm2_step PA1\n"


def test_compare_edges_stand_on_the_exact_ticks(run_image):
    run = run_image("timer_compare", "--ticks", "timer", pins=PINS)

    assert run.steps == [(700, 2, 1), (1000, 1, 1), (1500, 1, 2)]


def test_ticks_from_reset_are_those_of_the_timer_plus_a_constant(run_image):
    run = run_image("timer_compare", pins=PINS)
    first = run.steps[0][0]

    assert [tick - first for tick, _, _ in run.steps] == [0, 300, 800]
    microseconds = run.summary["first_step_microseconds"]
    assert first / 84 == pytest.approx(microseconds, abs=1 / 84)


def test_the_table_says_the_rate_of_the_timer(run_image):
    run = run_image("timer_compare", pins=PINS)

    first, second = (run.folder / "steps.csv").read_text().splitlines()[:2]
    assert first == "# tick_hz=84000000"
    assert second == "tick,motor,position"


def test_a_flag_is_cleared_by_writing_0_and_kept_by_writing_1(run_image):
    result = run_image("timer_compare", pins=PINS).result

    assert result[1] & 6 == 6
    assert result[2] & 6 == 4


def test_output_modes_force_the_pin_and_wait_for_the_next_match(run_image):
    result = run_image("timer_compare", pins=PINS).result

    assert result[3] & 1 == 1  # active on match
    assert result[4] & 1 == 0  # forced inactive
    assert result[5] & 1 == 0  # active on match again, but none has come
    assert result[6] == 1  # the second match; channel 2 has toggled back


def test_the_counter_is_read_while_it_runs(run_image):
    assert 1000 < run_image("timer_compare", pins=PINS).result[0] < 1030


def test_prescaler_and_period_count_from_0(run_image):
    result = run_image("timer_modes").result

    assert result[0] == 1  # UIF by EGR
    assert result[1] == 100
    assert result[6] == 0xFFFF


def test_a_compare_value_that_has_gone_by_waits_for_the_next_turn(run_image):
    result = run_image("timer_modes").result

    assert result[2] == 50 + 40
    assert result[3] == 40 or result[3] == 41


def test_one_pulse_mode_stops_at_the_update(run_image):
    result = run_image("timer_modes").result

    assert result[4] == 1 << 3
    assert result[5] == 0


def test_a_preloaded_compare_value_waits_for_the_update(run_image):
    result = run_image("preload").result

    assert result[0] in (30, 31)
    assert result[1] in (60, 61)


def test_a_pulse_and_the_gap_behind_it_are_measured(run_image):
    motor = run_image("timer_compare", pins=PINS).summary["motors"][0]

    assert motor["period_min"] == pytest.approx(500 / 84, abs=1e-5)
    assert motor["width_min"] + motor["gap_min"] == pytest.approx(500 / 84, abs=1e-5)


def test_two_runs_write_the_same_bytes(run_image):
    first = run_image("timer_compare", pins=PINS)
    wave = (first.folder / "wave.vcd").read_bytes()
    steps = (first.folder / "steps.csv").read_bytes()
    second = run_image("timer_compare", pins=PINS)

    assert (second.folder / "wave.vcd").read_bytes() == wave
    assert (second.folder / "steps.csv").read_bytes() == steps


def test_many_interrupts_a_second_are_all_served(run_image):
    run = run_image("spin")

    assert run.vector("TIM2")["count"] == run.result[0] == 40000


@pytest.mark.parametrize(("options", "flag"), [([], 0), (["--match-equal"], 2)])
def test_a_compare_value_that_the_counter_stands_on_matches_if_asked_to(run_image, options, flag):
    result = run_image("equal", *options).result

    assert result[0] == 5
    assert result[1] == flag
    assert result[2] == flag
