#include "base_tick.h"
#include "mover.h"
#include "mover_bench.h"
#include "unity.h"

/* What inputs do to a move. */

static struct mover_bench bench;

/* The input of each kind of guard; N is 1 where nothing else is said. */
enum {
    M = 1U << 2,
    N = 1U << 3,
    X = 1U << 4,
    LIMIT = 1U << 5
};

void setUp(void)
{
    mover_bench_init(&bench);
}

void tearDown(void)
{
    mover_bench_check(&bench);
}

static void start_guarded(const struct motion_order *order, struct mover_guards guards)
{
    mover_bench_start(&bench, order, guards, N);
}

/* Guards at the start */

static void assert_no_step_at_start(struct mover_guards guards, uint8_t inputs, enum hal_trace_stop cause)
{
    mover_bench_start(&bench, &mover_bench_trapezoid, guards, inputs);

    mover_bench_run(&bench);

    mover_bench_assert_steps(&bench, 0);
    mover_bench_assert_cause(&bench, cause);
    TEST_ASSERT_EQUAL_UINT64(bench.machine.epoch, mover_end_tick(&bench.mover));
}

void test_a_high_guard_that_is_high_at_the_start_allows_no_step(void)
{
    assert_no_step_at_start((struct mover_guards){.stop_high = M}, M, HAL_TRACE_STOP_HIGH);
}

void test_a_low_guard_that_is_low_at_the_start_allows_no_step(void)
{
    assert_no_step_at_start((struct mover_guards){.stop_low = N}, 0, HAL_TRACE_STOP_LOW);
}

void test_a_total_stop_that_is_high_at_the_start_allows_no_step(void)
{
    assert_no_step_at_start((struct mover_guards){.stop_total = X}, X, HAL_TRACE_STOP_TOTAL);
}

void test_a_limit_that_is_high_at_the_start_allows_no_step(void)
{
    assert_no_step_at_start((struct mover_guards){.halt_high = LIMIT}, LIMIT, HAL_TRACE_STOP_LIMIT);
}

void test_guards_with_the_other_level_at_the_start_let_the_motor_go(void)
{
    const struct mover_guards guards = {.stop_high = M, .stop_low = N, .stop_total = X};
    mover_bench_start(&bench, &mover_bench_trapezoid, guards, (uint8_t)~(M | X));
    bench.machine.inputs = N;

    mover_bench_run(&bench);

    mover_bench_assert_steps(&bench, 5000);
}

void test_a_total_stop_is_told_before_the_guards_and_they_before_the_limit(void)
{
    struct mover_guards guards = {.stop_high = M, .stop_low = N, .stop_total = X, .halt_high = LIMIT};
    mover_bench_start(&bench, &mover_bench_slow, guards, M | X | LIMIT);
    TEST_ASSERT_EQUAL_INT(HAL_TRACE_STOP_TOTAL, mover_stop_cause(&bench.mover));

    mover_bench_start(&bench, &mover_bench_slow, guards, M | LIMIT);
    TEST_ASSERT_EQUAL_INT(HAL_TRACE_STOP_HIGH, mover_stop_cause(&bench.mover));

    mover_bench_start(&bench, &mover_bench_slow, guards, LIMIT);
    TEST_ASSERT_EQUAL_INT(HAL_TRACE_STOP_LOW, mover_stop_cause(&bench.mover));
}

void test_the_cause_of_one_move_is_forgotten_in_the_next(void)
{
    assert_no_step_at_start((struct mover_guards){.stop_high = M}, M, HAL_TRACE_STOP_HIGH);

    start_guarded(&mover_bench_slow, (struct mover_guards){.stop_high = M});

    TEST_ASSERT_EQUAL_INT(HAL_TRACE_STOP_NONE, mover_stop_cause(&bench.mover));
    mover_bench_run(&bench);
}

/* Stops by inputs: at 1000 ms pulse 798 is armed in cruise, and 247 steps bring the motor down to S. */

static void assert_ramp_stop(struct mover_guards guards, uint8_t input, enum hal_trace_stop cause)
{
    mover_bench_set_inputs(&bench, N, input, 1000);
    start_guarded(&mover_bench_trapezoid, guards);

    mover_bench_run(&bench);

    mover_bench_assert_steps(&bench, 798 + 247);
    mover_bench_assert_cause(&bench, cause);
    TEST_ASSERT_EQUAL_UINT(1, bench.stops_sensed);
}

void test_a_high_guard_stops_down_the_ramp(void)
{
    assert_ramp_stop((struct mover_guards){.stop_high = M}, M, HAL_TRACE_STOP_HIGH);
}

void test_a_low_guard_stops_down_the_ramp(void)
{
    assert_ramp_stop((struct mover_guards){.stop_low = N}, N, HAL_TRACE_STOP_LOW);
}

void test_a_total_stop_stops_down_the_ramp(void)
{
    assert_ramp_stop((struct mover_guards){.stop_total = X}, X, HAL_TRACE_STOP_TOTAL);
}

void test_a_limit_ends_the_run_at_once(void)
{
    mover_bench_set_inputs(&bench, N, LIMIT, 105);
    start_guarded(&mover_bench_slow, (struct mover_guards){.halt_high = LIMIT});

    mover_bench_run(&bench);

    mover_bench_assert_steps(&bench, 10);
    mover_bench_assert_cause(&bench, HAL_TRACE_STOP_LIMIT);
    TEST_ASSERT_EQUAL_UINT64(bench.machine.epoch + 100 * TICKS_PER_MS, mover_end_tick(&bench.mover));
}

/* There is always more of it to be laid. */
static const struct motion_order endless = {
    .section = {{MOTION_ENDLESS_STEPS, 100, 2000}},
    .start_speed_steps_per_s = 100,
    .sections = 1,
};

void test_a_limit_ends_a_run_without_end_for_good(void)
{
    mover_bench_set_inputs(&bench, N, LIMIT, 105);
    start_guarded(&endless, (struct mover_guards){.halt_high = LIMIT});

    mover_bench_run(&bench);

    mover_bench_assert_steps(&bench, 10);
}

void test_a_limit_ends_a_run_at_once_also_behind_a_move_that_was_stopped(void)
{
    mover_bench_set_inputs(&bench, N, LIMIT, 2105);
    start_guarded(&mover_bench_trapezoid, (struct mover_guards){0});
    mover_bench_run_until(&bench, 1000 * TICKS_PER_MS);
    mover_stop(&bench.mover, HAL_TRACE_STOP_COMMAND);
    mover_bench_run_until(&bench, 1900 * TICKS_PER_MS);

    mover_start(&bench.mover, &endless, false, bench.machine.epoch + 1900 * TICKS_PER_MS,
                &(struct mover_guards){.halt_high = LIMIT});
    mover_bench_run(&bench);

    mover_bench_assert_steps(&bench, 798 + 247 + 20);
    TEST_ASSERT_EQUAL_INT(HAL_TRACE_STOP_LIMIT, mover_stop_cause(&bench.mover));
}

void test_an_input_that_guards_nothing_does_nothing(void)
{
    mover_bench_set_inputs(&bench, N, LIMIT, 1000);
    start_guarded(&mover_bench_trapezoid, (struct mover_guards){.stop_high = M, .stop_low = N, .stop_total = X});

    mover_bench_run(&bench);

    mover_bench_assert_steps(&bench, 5000);
    mover_bench_assert_cause(&bench, HAL_TRACE_STOP_NONE);
    TEST_ASSERT_EQUAL_UINT(0, bench.stops_sensed);
}

void test_an_input_at_rest_does_nothing(void)
{
    start_guarded(&mover_bench_slow, (struct mover_guards){.stop_high = M});
    mover_bench_run(&bench);

    TEST_ASSERT_FALSE(mover_sense_isr(&bench.mover, M, bench.machine.epoch));

    mover_bench_assert_cause(&bench, HAL_TRACE_STOP_NONE);
}

void test_a_guard_during_a_stop_changes_neither_ramp_nor_cause(void)
{
    mover_bench_set_inputs(&bench, N, M, 1100);
    start_guarded(&mover_bench_trapezoid, (struct mover_guards){.stop_high = M});
    mover_bench_run_until(&bench, 1000 * TICKS_PER_MS);

    mover_stop(&bench.mover, HAL_TRACE_STOP_COMMAND);
    mover_bench_run(&bench);

    mover_bench_assert_steps(&bench, 798 + 247);
    mover_bench_assert_cause(&bench, HAL_TRACE_STOP_COMMAND);
    TEST_ASSERT_EQUAL_UINT(0, bench.stops_sensed);
}
