#include <string.h>

#include "base_tick.h"
#include "mock_hal_driver.h"
#include "mock_hal_run.h"
#include "mock_hal_step.h"
#include "mock_hal_time.h"
#include "mock_hal_trace.h"
#include "axis.h"
#include "unity.h"

#include "late_rig.h"

/* Stops that are planned late, and inputs that are seen late. */

/* From 16 000 steps/s down to 100 takes 2133 steps at 60 000 steps/s^2, and from the 50th pulse of a ramp 50. */
static const struct motion_order ramped = {
    .section = {{4000, 16000, 60000}},
    .start_speed_steps_per_s = 100,
    .sections = 1,
};

void setUp(void)
{
    hal_driver_enable_Ignore();
    late_rig_init();
}

void tearDown(void)
{
}

void test_a_stop_below_the_start_speed_takes_effect_at_the_next_pulse(void)
{
    start(&fast, 10);
    braking_ticks = 3 * 5250;

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(11, pulses);
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_PAUSE, axis_cause(&axis));
}

/* Ends of moves that were stopped after pulse 50, by the time that planning took. */
static void assert_stopped_alike(uint64_t planning)
{
    static uint64_t expected[sizeof pulse_tick / sizeof *pulse_tick];
    setUp();
    start(&ramped, 50);
    stop();
    run_to_the_end();
    uint64_t made = pulses;
    memcpy(expected, pulse_tick, sizeof expected);

    setUp();
    start(&ramped, 50);
    braking_ticks = planning;
    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(made, pulses);
    for (unsigned i = 0; i < made; i++) {
        TEST_ASSERT_UINT64_WITHIN(1, expected[i], pulse_tick[i]);
    }
}

void test_a_stop_makes_the_same_pulses_however_long_planning_takes(void)
{
    assert_stopped_alike(1);
    assert_stopped_alike(TICK_HZ / 1000U);
    assert_stopped_alike(TICK_HZ / 200U);
}

/* Half of the way down to S is made without a plan, then the motor waits for it. */
void test_a_stop_that_is_planned_much_too_late_ends_on_its_step_all_the_same(void)
{
    start(&ramped, 50);
    stop();
    run_to_the_end();
    uint64_t made = pulses;

    setUp();
    start(&ramped, 50);
    braking_ticks = TICK_HZ;
    stop();
    TEST_ASSERT_EQUAL_UINT64((made + 51U) / 2U, pulses);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(made, pulses);
}

void test_a_stop_after_which_no_pulse_is_left_changes_nothing(void)
{
    start(&fast, 999);

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

void test_a_stop_takes_pulses_back_that_wait_while_it_looks(void)
{
    start(&fast, 10);
    looking_ticks = 5250;

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(11, pulses);
}

/* Two pulses come meanwhile: the stop acts at the second. */
void test_a_stop_that_looks_too_long_ago_acts_at_the_last_pulse_made(void)
{
    start(&fast, 10);
    looking_ticks = 2 * 5250;

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(12, pulses);
}

void test_a_stop_that_looks_too_long_ago_acts_at_the_third_pulse_if_that_cannot_be_taken_back(void)
{
    start(&fast, 10);
    looking_ticks = 2 * 5250;
    laid.too_late = 1;

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(13, pulses);
}

void test_a_stop_that_finds_the_last_pulse_made_where_it_brakes_changes_nothing(void)
{
    start(&fast, 998);
    looking_ticks = 2 * 5250;

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

void test_a_stop_that_cannot_take_the_last_pulse_back_changes_nothing(void)
{
    start(&fast, 997);
    looking_ticks = 2 * 5250;
    laid.too_late = 1;

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

/* After 50 pulses, an input changes so long ago; the pulses are those of a stop after `made`. */
static void assert_sensed_like_a_stop_after(unsigned made, uint64_t ago_ticks)
{
    static const struct axis_guards guards = {.stop_high = 1};
    start(&ramped, 50);
    now += 100;
    axis.guards = guards;
    TEST_ASSERT_TRUE(axis_sense_isr(&axis, 1, now - ago_ticks));
    axis_plan_isr(&axis);
    run_to_the_end();
    uint64_t sensed = pulses;

    setUp();
    start(&ramped, made);
    stop();
    run_to_the_end();
    TEST_ASSERT_EQUAL_UINT64(pulses, sensed);
}

void test_an_input_that_is_seen_late_stops_at_the_pulse_after_its_change(void)
{
    assert_sensed_like_a_stop_after(49, 101);
}

void test_a_pulse_on_the_tick_of_the_change_is_not_after_it(void)
{
    assert_sensed_like_a_stop_after(50, 100);
}

void test_a_stop_of_a_move_whose_end_main_has_not_seen_changes_nothing(void)
{
    start(&fast, 1000);

    stop();
    TEST_ASSERT_TRUE(axis_is_moving(&axis));
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

/* Without a plan the motor gets to the border; what was planned after it is there when main looks. */
void test_a_stop_that_is_planned_when_the_motor_waits_at_a_border_goes_on_after_it(void)
{
    static const struct motion_order two = {
        .section = {{1060, 16000, 60000}, {4000, 16000, 60000}},
        .start_speed_steps_per_s = 100,
        .sections = 2,
    };
    start(&two, 1050);
    stop();
    run_to_the_end();
    uint64_t made = pulses;

    setUp();
    start(&two, 1050);
    braking_ticks = TICK_HZ;
    stop();
    TEST_ASSERT_EQUAL_UINT64(1060, pulses);
    TEST_ASSERT_FALSE(is_waiting());
    run_to_the_end();

    TEST_ASSERT_GREATER_THAN_UINT64(1100, made);
    TEST_ASSERT_EQUAL_UINT64(made, pulses);
}
