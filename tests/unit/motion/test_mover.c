#include "base_tick.h"
#include "mover.h"
#include "mover_bench.h"
#include "unity.h"

/* Moves that nothing ends early. */

static struct mover_bench bench;
static const struct mover_guards no_guards = {0};

void setUp(void)
{
    mover_bench_init(&bench);
}

void tearDown(void)
{
    mover_bench_check(&bench);
}

static void start(const struct motion_order *order)
{
    mover_bench_start(&bench, order, (struct mover_guards){0}, 0);
}

void test_a_new_mover_stands_at_position_0(void)
{
    TEST_ASSERT_FALSE(mover_is_moving(&bench.mover));
    mover_bench_assert_steps(&bench, 0);
}

void test_a_move_makes_its_steps(void)
{
    start(&mover_bench_trapezoid);

    mover_bench_run(&bench);

    mover_bench_assert_steps(&bench, 5000);
    mover_bench_assert_cause(&bench, HAL_TRACE_STOP_NONE);
}

void test_a_move_is_started_with_its_first_segment_and_main_lays_the_others(void)
{
    start(&mover_bench_trapezoid);

    TEST_ASSERT_TRUE(step_channel_is_running(&bench.mover.channel));
    TEST_ASSERT_TRUE(mover_feed(&bench.mover));
    TEST_ASSERT_TRUE(mover_feed(&bench.mover));
    TEST_ASSERT_FALSE(mover_feed(&bench.mover));
    mover_bench_run(&bench);
}

void test_a_run_without_end_fills_the_queue(void)
{
    const struct motion_order endless = {
        .section = {{MOTION_ENDLESS_STEPS, 1000, 2000}},
        .start_speed_steps_per_s = 100,
        .sections = 1,
    };
    start(&endless);

    while (mover_feed(&bench.mover)) {
    }

    TEST_ASSERT_EQUAL_UINT32(0, step_channel_room(&bench.mover.channel));
    mover_stop(&bench.mover, HAL_TRACE_STOP_COMMAND);
    mover_bench_run(&bench);
}

void test_a_move_backward_counts_down(void)
{
    mover_start(&bench.mover, &mover_bench_trapezoid, true, bench.machine.epoch, &no_guards);

    mover_bench_run(&bench);

    mover_bench_assert_steps(&bench, -5000);
}

/* Two ramps of 0.45 s and 4505 steps at 1000 steps/s. */
void test_a_move_ends_with_the_tick_of_its_last_pulse(void)
{
    start(&mover_bench_trapezoid);

    mover_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT64((900 + 4505) * TICKS_PER_MS, bench.last_edge_tick);
    TEST_ASSERT_EQUAL_UINT64(bench.machine.epoch + bench.last_edge_tick, mover_end_tick(&bench.mover));
}

void test_a_move_is_in_progress_until_main_has_seen_its_end(void)
{
    start(&mover_bench_slow);
    TEST_ASSERT_TRUE(mover_is_moving(&bench.mover));
    mover_bench_run_until(&bench, 1000 * TICKS_PER_MS + 1);
    mover_bench_assert_steps(&bench, 100);
    TEST_ASSERT_TRUE(mover_is_moving(&bench.mover));

    mover_bench_run(&bench);

    TEST_ASSERT_FALSE(mover_is_moving(&bench.mover));
}

void test_a_move_may_begin_shortly_before_it_is_started(void)
{
    bench.machine.now = 300 * TICKS_PER_US;
    start(&mover_bench_slow);

    mover_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT64(1000 * TICKS_PER_MS, bench.last_edge_tick);
}

void test_moves_join_without_drift(void)
{
    start(&mover_bench_slow);
    mover_bench_run(&bench);

    mover_start(&bench.mover, &mover_bench_slow, false, mover_end_tick(&bench.mover), &no_guards);
    mover_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT64(2000 * TICKS_PER_MS, bench.last_edge_tick);
    TEST_ASSERT_EQUAL_INT64(200, mover_position_steps(&bench.mover));
}

void test_the_position_can_be_set(void)
{
    mover_set_position(&bench.mover, -2000000000);
    start(&mover_bench_slow);

    mover_bench_run(&bench);

    TEST_ASSERT_EQUAL_INT64(-1999999900, mover_position_steps(&bench.mover));
}

void test_polling_at_rest_does_nothing(void)
{
    mover_poll(&bench.mover);

    TEST_ASSERT_FALSE(mover_is_moving(&bench.mover));
}

void test_the_begin_of_the_last_section_can_be_taken_once(void)
{
    const struct motion_order order = {
        .section = {{10, 100, 2000}, {10, 100, 2000}},
        .start_speed_steps_per_s = 100,
        .sections = 2,
    };
    start(&order);
    mover_bench_run_until(&bench, 95 * TICKS_PER_MS);
    TEST_ASSERT_FALSE(mover_take_mark(&bench.mover));
    mover_bench_run_until(&bench, 105 * TICKS_PER_MS);

    TEST_ASSERT_TRUE(mover_take_mark(&bench.mover));
    TEST_ASSERT_FALSE(mover_take_mark(&bench.mover));
    mover_bench_run(&bench);
}

void test_a_move_has_corners_while_it_lasts(void)
{
    struct motion_corner corners[MOTION_CORNERS_MAX];
    TEST_ASSERT_EQUAL_UINT(0, mover_corners(&bench.mover, corners));
    start(&mover_bench_trapezoid);
    TEST_ASSERT_EQUAL_UINT(4, mover_corners(&bench.mover, corners));

    mover_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT(0, mover_corners(&bench.mover, corners));
}

static struct motion_order order_of(uint64_t steps)
{
    return (struct motion_order){.section = {{steps, 1000, 2000}}, .start_speed_steps_per_s = 1000, .sections = 1};
}

static void move(uint64_t steps)
{
    struct motion_order order = order_of(steps);
    mover_start(&bench.mover, &order, false, bench.machine.epoch + bench.machine.now, &no_guards);
    mover_bench_run(&bench);
}

void test_a_mover_is_connected_at_first(void)
{
    mover_connect(&bench.mover, true);

    move(7);

    TEST_ASSERT_EQUAL_UINT(7, bench.edges);
}

void test_a_disconnected_mover_counts_but_shows_no_pulse(void)
{
    mover_connect(&bench.mover, false);

    move(7);

    TEST_ASSERT_EQUAL_UINT(0, bench.edges);
    TEST_ASSERT_EQUAL_INT64(7, mover_position_steps(&bench.mover));
}

void test_the_position_goes_back_when_a_mover_is_connected_again(void)
{
    move(5);
    mover_connect(&bench.mover, false);
    move(7);
    mover_set_position(&bench.mover, 1000);

    mover_connect(&bench.mover, true);

    TEST_ASSERT_EQUAL_INT64(5, mover_position_steps(&bench.mover));
}

void test_a_mover_that_is_disconnected_twice_goes_back_to_where_it_first_was(void)
{
    move(5);
    mover_connect(&bench.mover, false);
    move(7);
    mover_connect(&bench.mover, false);

    mover_connect(&bench.mover, true);
    mover_connect(&bench.mover, true);
    move(1);

    TEST_ASSERT_EQUAL_INT64(6, mover_position_steps(&bench.mover));
}
