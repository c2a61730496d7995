"""The timers of the virtual board: edges at the exact tick, flags, modes."""

from __future__ import annotations

import pytest

PINS = "m1_step PA0\nm2_step PA1\n"
ALL_PINS = PINS + "m3_step PA2\nm4_step PA3\n"
LOW, HIGH = 0, 1
FLAG = 2


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

    assert result[2] in (50 + 40, 50 + 41)  # by the processor's cycles, and the writes take some
    assert result[3] == 40 or result[3] == 41


def test_one_pulse_mode_stops_at_the_update(run_image):
    result = run_image("timer_modes").result

    assert result[4] == 1 << 3
    assert result[5] == 0


def test_a_preloaded_compare_value_waits_for_the_update(run_image):
    result = run_image("preload").result

    assert result[0] in (30, 31)
    assert result[1] in (60, 61)


def test_a_pulse_and_the_gap_after_it_are_measured(run_image):
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


def test_pwm_edges_stand_on_the_compare_value_and_on_the_turn(run_image):
    run = run_image("timer_pwm", "--ticks", "timer", pins=ALL_PINS, defines=["EDGES"])
    ticks = {m: [tick for tick, motor, _ in run.steps if motor == m] for m in range(1, 5)}

    # Mode 1 is high below the value, mode 2 from it on; the second of each is upside down. The
    # first levels come before the timer starts.
    assert ticks[1][1:3] == ticks[4][1:3] == [100, 200]
    assert ticks[2][:3] == ticks[3][:3] == [40, 140, 240]


def test_pwm_of_0_is_always_low_and_above_the_period_always_high(run_image):
    result = run_image("timer_pwm", defines=["ENDS"]).result

    assert result[0] == 0b1110
    assert result[1] == 0
    assert result[2] == 0b1100  # the second one has matched on the last tick
    assert result[3] == 0b00100
    assert result[4] == 0b1110
    assert result[5] == 0b11111  # those above the period set their flag when the counter turns


@pytest.mark.parametrize(("options", "flag"), [([], 0), (["--match-equal"], FLAG)])
def test_pwm_2_is_high_from_the_value_on_and_low_as_soon_as_it_lies_ahead(run_image, options, flag):
    result = run_image("timer_pwm", *options, defines=["MOVES"]).result

    assert result[0:4] == [LOW, LOW, HIGH, FLAG]
    assert result[4:7] == [LOW, LOW, HIGH]  # moved ahead, waiting, reached
    assert result[7:10] == [LOW, HIGH, 0]  # ahead, then after: high without a match
    assert result[10:12] == [HIGH, flag]  # equal
    assert result[12:14] == [LOW, HIGH]  # the counter set back
    assert result[14:16] == [HIGH, LOW]  # and turning over


@pytest.mark.parametrize(("options", "left"), [([], LOW), (["--pwm-at-once"], HIGH)])
def test_pwm_after_a_forced_level_waits_for_a_change_of_the_comparison(run_image, options, left):
    result = run_image("timer_pwm", *options, defines=["FORCED"]).result

    assert result[0:2] == [HIGH, HIGH]
    assert result[2:5] == [LOW, HIGH, LOW]
    assert result[5] == left
    assert result[6] == HIGH
    assert result[7:9] == [HIGH, LOW]  # from frozen it is shown at once


def test_modes_that_wait_for_a_match_act_on_it_alone_and_flags_come_in_every_mode(run_image):
    result = run_image("timer_pwm", defines=["MATCHES"]).result

    assert result[0:2] == [LOW, HIGH]  # active on match
    assert result[2:4] == [HIGH, LOW]  # inactive on match
    assert result[4:6] == [HIGH, LOW]  # toggle
    assert result[6:8] == [LOW, FLAG]  # frozen
    assert result[8] == FLAG  # forced
    assert result[9] == FLAG  # by EGR, which moves no output
    assert result[10:12] == [LOW, LOW]  # high, upside down; then off


def test_preload_holds_a_value_back_until_the_update(run_image):
    result = run_image("timer_pwm", defines=["PRELOADED"]).result

    assert result[0:3] == [HIGH, HIGH, 60]
    assert result[3:5] == [LOW, LOW]
    assert result[5] == HIGH
    assert result[6] == 49
    assert result[7:10] == [1, 0, 0]  # UIF by overflow; not with UDIS, nor by UG with URS


def test_one_pulse_ends_with_any_update_and_a_period_of_0_blocks_the_counter(run_image):
    result = run_image("timer_pwm", defines=["STOPS"]).result

    assert result[0:2] == [0, LOW]
    assert result[2] == 0
    assert result[3] == 0


@pytest.mark.parametrize(("wait", "cycles"), [(0, 0), (8, 2), (40, 10)])
def test_a_read_of_the_counter_costs_a_load_and_the_wait_of_its_undivided_bus(
    run_image, wait, cycles
):
    result = run_image("timer_pwm", "--apb-wait", str(wait), defines=["READS"]).result

    assert result[0] == 1 + 2 + cycles
