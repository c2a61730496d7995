#include "base_tick.h"
#include "axis.h"
#include "axis_bench.h"
#include "unity.h"

/* Stops and changes of speed by main. */

static struct axis_bench bench;

void setUp(void)
{
    axis_bench_init(&bench);
}

void tearDown(void)
{
    axis_bench_check(&bench);
}

static void start(const struct motion_order *order)
{
    axis_bench_start(&bench, order, (struct axis_guards){0}, 0);
}

/* Stops by main */

/* At 1000 ms pulse 798 is next in cruise, and 247 steps bring the motor down to S. */
void test_a_stop_ends_down_the_ramp(void)
{
    start(&axis_bench_trapezoid);
    axis_bench_run_until(&bench, 1000 * TICKS_PER_MS);

    axis_stop(&bench.axis, AXIS_CAUSE_PAUSE);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 798 + 247);
    axis_bench_assert_cause(&bench, AXIS_CAUSE_PAUSE);
}

void test_a_stop_at_S_ends_with_the_pulse_that_is_due(void)
{
    start(&axis_bench_slow);
    axis_bench_run_until(&bench, 105 * TICKS_PER_MS);

    axis_stop(&bench.axis, AXIS_CAUSE_COMMAND);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 11);
    axis_bench_assert_cause(&bench, AXIS_CAUSE_COMMAND);
}

void test_a_stop_before_the_last_pulse_lets_it_come(void)
{
    start(&axis_bench_slow);
    axis_bench_run_until(&bench, 995 * TICKS_PER_MS);

    axis_stop(&bench.axis, AXIS_CAUSE_PAUSE);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 100);
}

void test_a_second_stop_does_nothing(void)
{
    start(&axis_bench_trapezoid);
    axis_bench_run_until(&bench, 1000 * TICKS_PER_MS);
    axis_stop(&bench.axis, AXIS_CAUSE_PAUSE);
    axis_bench_run_until(&bench, 1100 * TICKS_PER_MS);

    axis_stop(&bench.axis, AXIS_CAUSE_COMMAND);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 798 + 247);
    axis_bench_assert_cause(&bench, AXIS_CAUSE_PAUSE);
}

void test_a_stop_at_rest_does_nothing(void)
{
    axis_stop(&bench.axis, AXIS_CAUSE_PAUSE);

    axis_bench_assert_cause(&bench, AXIS_CAUSE_NONE);
}

/* The plan interrupt comes for all motors when one of them is to be stopped. */
void test_the_plan_interrupt_leaves_a_motor_alone_that_nothing_stops(void)
{
    start(&axis_bench_trapezoid);
    axis_bench_run_until(&bench, 1000 * TICKS_PER_MS);

    axis_plan_isr(&bench.axis);
    axis_plan_isr(&bench.axis);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 5000);
}

void test_a_run_without_end_is_stopped(void)
{
    const struct motion_order endless = {
        .section = {motion_order_endless(1000, 2000)},
        .start_speed_steps_per_s = 100,
        .sections = 1,
    };
    start(&endless);
    axis_bench_run_until(&bench, UINT64_C(100000) * TICKS_PER_MS);

    axis_stop(&bench.axis, AXIS_CAUSE_PAUSE);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 99798 + 247);
}

/* Changes of speed */

void test_a_change_of_speed_keeps_the_target(void)
{
    start(&axis_bench_trapezoid);
    axis_bench_run_until(&bench, 1000 * TICKS_PER_MS);

    axis_change_speed(&bench.axis, 16000);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 5000);
    axis_bench_assert_only_event(&bench, HAL_TRACE_SPEED, 16000);
    TEST_ASSERT_LESS_THAN_UINT64((900 + 4505) * TICKS_PER_MS, bench.last_edge_tick);
}

void test_a_change_of_speed_while_stopping_does_nothing(void)
{
    start(&axis_bench_trapezoid);
    axis_bench_run_until(&bench, 1000 * TICKS_PER_MS);
    axis_stop(&bench.axis, AXIS_CAUSE_PAUSE);

    axis_change_speed(&bench.axis, 16000);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 798 + 247);
    axis_bench_assert_cause(&bench, AXIS_CAUSE_PAUSE);
}

void test_a_change_of_speed_in_a_limit_run_does_nothing(void)
{
    axis_bench_start(&bench, &axis_bench_slow, (struct axis_guards){.halt_high = 1}, 0);
    axis_bench_run_until(&bench, 100 * TICKS_PER_MS);

    axis_change_speed(&bench.axis, 16000);
    axis_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT64(1000 * TICKS_PER_MS, bench.last_edge_tick);
    axis_bench_assert_cause(&bench, AXIS_CAUSE_NONE);
}

void test_a_change_of_speed_at_rest_does_nothing(void)
{
    axis_change_speed(&bench.axis, 16000);

    axis_bench_assert_cause(&bench, AXIS_CAUSE_NONE);
}

void test_a_change_of_speed_before_the_last_pulse_does_nothing(void)
{
    start(&axis_bench_slow);
    axis_bench_run_until(&bench, 995 * TICKS_PER_MS);

    axis_change_speed(&bench.axis, 16000);
    axis_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT64(1000 * TICKS_PER_MS, bench.last_edge_tick);
    axis_bench_assert_cause(&bench, AXIS_CAUSE_NONE);
}

void test_a_change_of_speed_can_be_followed_by_a_stop(void)
{
    start(&axis_bench_trapezoid);
    axis_bench_run_until(&bench, 1000 * TICKS_PER_MS);
    axis_change_speed(&bench.axis, 500);

    axis_stop(&bench.axis, AXIS_CAUSE_PAUSE);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 798 + 247);
}

/* More segments than a cut hands over at once: they follow from the queue. */
void test_a_change_in_the_first_of_ten_sections_keeps_all_that_follow(void)
{
    struct motion_order order = {.start_speed_steps_per_s = 100, .sections = MOTION_SECTIONS};
    for (unsigned i = 0; i < MOTION_SECTIONS; i++) {
        order.section[i] = (struct motion_section){200 + i, i % 2U == 0 ? 500 : 1000, 20000};
    }
    start(&order);
    axis_bench_run_until(&bench, 100 * TICKS_PER_MS);

    axis_change_speed(&bench.axis, 1500);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 2045);
}
