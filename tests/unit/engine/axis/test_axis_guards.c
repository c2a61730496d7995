#include "base_tick.h"
#include "axis.h"
#include "axis_bench.h"
#include "unity.h"

/* What inputs do to a move. */

static struct axis_bench bench;

/* The input of each kind of guard; N is 1 where nothing else is said. */
enum {
    M = 1U << 2,
    N = 1U << 3,
    X = 1U << 4,
    LIMIT = 1U << 5
};

void setUp(void)
{
    axis_bench_init(&bench);
}

void tearDown(void)
{
    axis_bench_check(&bench);
}

static void start_guarded(const struct motion_order *order, struct axis_guards guards)
{
    axis_bench_start(&bench, order, guards, N);
}

/* Guards at the start */

static void assert_no_step_at_start(struct axis_guards guards, uint8_t inputs, enum axis_cause cause)
{
    axis_bench_start(&bench, &axis_bench_trapezoid, guards, inputs);

    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 0);
    axis_bench_assert_cause(&bench, cause);
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, bench.machine.enabled_tick);
    TEST_ASSERT_EQUAL_UINT64(bench.machine.epoch, axis_end_tick(&bench.axis));
}

void test_a_high_guard_that_is_high_at_the_start_allows_no_step(void)
{
    assert_no_step_at_start((struct axis_guards){.stop_high = M}, M, AXIS_CAUSE_HIGH);
}

void test_a_low_guard_that_is_low_at_the_start_allows_no_step(void)
{
    assert_no_step_at_start((struct axis_guards){.stop_low = N}, 0, AXIS_CAUSE_LOW);
}

void test_a_total_stop_that_is_high_at_the_start_allows_no_step(void)
{
    assert_no_step_at_start((struct axis_guards){.abort_high = X}, X, AXIS_CAUSE_ABORT);
}

void test_a_limit_that_is_high_at_the_start_allows_no_step(void)
{
    assert_no_step_at_start((struct axis_guards){.halt_high = LIMIT}, LIMIT, AXIS_CAUSE_LIMIT);
}

void test_guards_with_the_other_level_at_the_start_let_the_motor_go(void)
{
    const struct axis_guards guards = {.stop_high = M, .stop_low = N, .abort_high = X};
    axis_bench_start(&bench, &axis_bench_trapezoid, guards, (uint8_t)~(M | X));
    bench.machine.inputs = N;

    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 5000);
}

void test_a_total_stop_is_told_before_the_guards_and_they_before_the_limit(void)
{
    struct axis_guards guards = {.stop_high = M, .stop_low = N, .abort_high = X, .halt_high = LIMIT};
    axis_bench_start(&bench, &axis_bench_slow, guards, M | X | LIMIT);
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_ABORT, axis_cause(&bench.axis));

    axis_bench_start(&bench, &axis_bench_slow, guards, M | LIMIT);
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_HIGH, axis_cause(&bench.axis));

    axis_bench_start(&bench, &axis_bench_slow, guards, LIMIT);
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_LOW, axis_cause(&bench.axis));
}

void test_the_cause_of_one_move_is_forgotten_in_the_next(void)
{
    assert_no_step_at_start((struct axis_guards){.stop_high = M}, M, AXIS_CAUSE_HIGH);

    start_guarded(&axis_bench_slow, (struct axis_guards){.stop_high = M});

    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_NONE, axis_cause(&bench.axis));
    axis_bench_run(&bench);
}

/* Stops by inputs: at 1000 ms pulse 798 is next in cruise, and 247 steps bring the motor down to S. */

static void assert_ramp_stop(struct axis_guards guards, uint8_t input, enum axis_cause cause)
{
    axis_bench_set_inputs(&bench, N, input, 1000);
    start_guarded(&axis_bench_trapezoid, guards);

    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 798 + 247);
    axis_bench_assert_cause(&bench, cause);
    TEST_ASSERT_EQUAL_UINT(1, bench.stops_sensed);
}

void test_a_high_guard_stops_down_the_ramp(void)
{
    assert_ramp_stop((struct axis_guards){.stop_high = M}, M, AXIS_CAUSE_HIGH);
}

void test_a_low_guard_stops_down_the_ramp(void)
{
    assert_ramp_stop((struct axis_guards){.stop_low = N}, N, AXIS_CAUSE_LOW);
}

void test_a_total_stop_stops_down_the_ramp(void)
{
    assert_ramp_stop((struct axis_guards){.abort_high = X}, X, AXIS_CAUSE_ABORT);
}

void test_a_limit_ends_the_run_at_once(void)
{
    axis_bench_set_inputs(&bench, N, LIMIT, 105);
    start_guarded(&axis_bench_slow, (struct axis_guards){.halt_high = LIMIT});

    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 10);
    axis_bench_assert_cause(&bench, AXIS_CAUSE_LIMIT);
    TEST_ASSERT_EQUAL_UINT64(bench.machine.epoch + 100 * TICKS_PER_MS, axis_end_tick(&bench.axis));
}

/* There is always more of it to be laid. */
static struct motion_order endless_order(void)
{
    return (struct motion_order){
        .section = {motion_order_endless(100, 2000)},
        .start_speed_steps_per_s = 100,
        .sections = 1,
    };
}

void test_a_limit_ends_a_run_without_end_for_good(void)
{
    const struct motion_order endless = endless_order();
    axis_bench_set_inputs(&bench, N, LIMIT, 105);
    start_guarded(&endless, (struct axis_guards){.halt_high = LIMIT});

    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 10);
}

void test_a_limit_ends_a_run_at_once_also_after_a_move_that_was_stopped(void)
{
    const struct motion_order endless = endless_order();
    axis_bench_set_inputs(&bench, N, LIMIT, 2105);
    start_guarded(&axis_bench_trapezoid, (struct axis_guards){0});
    axis_bench_run_until(&bench, 1000 * TICKS_PER_MS);
    axis_stop(&bench.axis, AXIS_CAUSE_PAUSE);
    axis_bench_run_until(&bench, 1900 * TICKS_PER_MS);

    axis_begin(&bench.axis, &endless, false, bench.machine.epoch + 1900 * TICKS_PER_MS,
               &(struct axis_guards){.halt_high = LIMIT});
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 798 + 247 + 20);
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_LIMIT, axis_cause(&bench.axis));
}

void test_an_input_that_guards_nothing_does_nothing(void)
{
    axis_bench_set_inputs(&bench, N, LIMIT, 1000);
    start_guarded(&axis_bench_trapezoid, (struct axis_guards){.stop_high = M, .stop_low = N, .abort_high = X});

    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 5000);
    axis_bench_assert_cause(&bench, AXIS_CAUSE_NONE);
    TEST_ASSERT_EQUAL_UINT(0, bench.stops_sensed);
}

void test_an_input_at_rest_does_nothing(void)
{
    start_guarded(&axis_bench_slow, (struct axis_guards){.stop_high = M});
    axis_bench_run(&bench);

    TEST_ASSERT_FALSE(axis_sense_isr(&bench.axis, M, bench.machine.epoch));

    axis_bench_assert_cause(&bench, AXIS_CAUSE_NONE);
}

void test_a_guard_during_a_stop_changes_neither_ramp_nor_cause(void)
{
    axis_bench_set_inputs(&bench, N, M, 1100);
    start_guarded(&axis_bench_trapezoid, (struct axis_guards){.stop_high = M});
    axis_bench_run_until(&bench, 1000 * TICKS_PER_MS);

    axis_stop(&bench.axis, AXIS_CAUSE_PAUSE);
    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 798 + 247);
    axis_bench_assert_cause(&bench, AXIS_CAUSE_PAUSE);
    TEST_ASSERT_EQUAL_UINT(0, bench.stops_sensed);
}
