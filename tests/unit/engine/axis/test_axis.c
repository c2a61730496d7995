#include "base_tick.h"
#include "axis.h"
#include "axis_bench.h"
#include "unity.h"

/* Moves that nothing ends early. */

static struct axis_bench bench;
static const struct axis_guards no_guards = {0};

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

void test_a_new_axis_stands_at_position_0(void)
{
    TEST_ASSERT_FALSE(axis_is_moving(&bench.axis));
    axis_bench_assert_steps(&bench, 0);
}

void test_a_move_makes_its_steps(void)
{
    start(&axis_bench_trapezoid);

    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, 5000);
    axis_bench_assert_cause(&bench, AXIS_CAUSE_NONE);
}

void test_the_drivers_are_switched_on_when_a_move_begins(void)
{
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, bench.machine.enabled_tick);

    axis_bench_run_until(&bench, 5 * TICKS_PER_MS);
    start(&axis_bench_trapezoid);
    axis_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT64(5 * TICKS_PER_MS, bench.machine.enabled_tick);
}

void test_a_move_is_started_with_its_first_segment_and_main_lays_the_others(void)
{
    start(&axis_bench_trapezoid);

    TEST_ASSERT_TRUE(step_channel_is_running(&bench.axis.channel));
    TEST_ASSERT_TRUE(axis_feed(&bench.axis));
    TEST_ASSERT_TRUE(axis_feed(&bench.axis));
    TEST_ASSERT_FALSE(axis_feed(&bench.axis));
    axis_bench_run(&bench);
}

void test_a_run_without_end_fills_the_queue(void)
{
    const struct motion_order endless = {
        .section = {motion_order_endless(1000, 2000)},
        .start_speed_steps_per_s = 100,
        .sections = 1,
    };
    start(&endless);

    while (axis_feed(&bench.axis)) {
    }

    TEST_ASSERT_EQUAL_UINT32(0, step_channel_room(&bench.axis.channel));
    axis_stop(&bench.axis, AXIS_CAUSE_PAUSE);
    axis_bench_run(&bench);
}

void test_a_move_backward_counts_down(void)
{
    axis_begin(&bench.axis, &axis_bench_trapezoid, true, bench.machine.epoch, &no_guards);

    axis_bench_run(&bench);

    axis_bench_assert_steps(&bench, -5000);
}

/* Two ramps of 0.45 s and 4505 steps at 1000 steps/s. */
void test_a_move_ends_with_the_tick_of_its_last_pulse(void)
{
    start(&axis_bench_trapezoid);

    axis_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT64((900 + 4505) * TICKS_PER_MS, bench.last_edge_tick);
    TEST_ASSERT_EQUAL_UINT64(bench.machine.epoch + bench.last_edge_tick, axis_end_tick(&bench.axis));
}

void test_a_move_is_in_progress_until_main_has_seen_its_end(void)
{
    start(&axis_bench_slow);
    TEST_ASSERT_TRUE(axis_is_moving(&bench.axis));
    axis_bench_run_until(&bench, 1000 * TICKS_PER_MS + 1);
    axis_bench_assert_steps(&bench, 100);
    TEST_ASSERT_TRUE(axis_is_moving(&bench.axis));

    axis_bench_run(&bench);

    TEST_ASSERT_FALSE(axis_is_moving(&bench.axis));
}

void test_a_move_may_begin_shortly_before_it_is_started(void)
{
    bench.machine.now = 300 * TICKS_PER_US;
    start(&axis_bench_slow);

    axis_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT64(1000 * TICKS_PER_MS, bench.last_edge_tick);
}

void test_moves_join_without_drift(void)
{
    start(&axis_bench_slow);
    axis_bench_run(&bench);

    axis_begin(&bench.axis, &axis_bench_slow, false, axis_end_tick(&bench.axis), &no_guards);
    axis_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT64(2000 * TICKS_PER_MS, bench.last_edge_tick);
    TEST_ASSERT_EQUAL_INT64(200, axis_position_steps(&bench.axis));
}

void test_the_position_can_be_set(void)
{
    axis_set_position(&bench.axis, -2000000000);
    start(&axis_bench_slow);

    axis_bench_run(&bench);

    TEST_ASSERT_EQUAL_INT64(-1999999900, axis_position_steps(&bench.axis));
}

void test_polling_at_rest_does_nothing(void)
{
    axis_poll(&bench.axis);

    TEST_ASSERT_FALSE(axis_is_moving(&bench.axis));
}

void test_the_begin_of_the_last_section_can_be_taken_once(void)
{
    const struct motion_order order = {
        .section = {{10, 100, 2000}, {10, 100, 2000}},
        .start_speed_steps_per_s = 100,
        .sections = 2,
    };
    start(&order);
    axis_bench_run_until(&bench, 95 * TICKS_PER_MS);
    TEST_ASSERT_FALSE(axis_take_mark(&bench.axis));
    axis_bench_run_until(&bench, 105 * TICKS_PER_MS);

    TEST_ASSERT_TRUE(axis_take_mark(&bench.axis));
    TEST_ASSERT_FALSE(axis_take_mark(&bench.axis));
    axis_bench_run(&bench);
}

void test_a_move_has_corners_while_it_lasts(void)
{
    struct motion_corner corners[MOTION_CORNERS_MAX];
    TEST_ASSERT_EQUAL_UINT(0, axis_corners(&bench.axis, corners));
    start(&axis_bench_trapezoid);
    TEST_ASSERT_EQUAL_UINT(4, axis_corners(&bench.axis, corners));

    axis_bench_run(&bench);

    TEST_ASSERT_EQUAL_UINT(0, axis_corners(&bench.axis, corners));
}

static struct motion_order order_of(uint64_t steps)
{
    return (struct motion_order){.section = {{steps, 1000, 2000}}, .start_speed_steps_per_s = 1000, .sections = 1};
}

static void move(uint64_t steps)
{
    struct motion_order order = order_of(steps);
    axis_begin(&bench.axis, &order, false, bench.machine.epoch + bench.machine.now, &no_guards);
    axis_bench_run(&bench);
}

void test_an_axis_is_connected_at_first(void)
{
    axis_simulate(&bench.axis, false);

    move(7);

    TEST_ASSERT_EQUAL_UINT(7, bench.edges);
}

void test_a_disconnected_axis_counts_but_shows_no_pulse(void)
{
    axis_simulate(&bench.axis, true);

    move(7);

    TEST_ASSERT_EQUAL_UINT(0, bench.edges);
    TEST_ASSERT_EQUAL_INT64(7, axis_position_steps(&bench.axis));
}

void test_the_position_goes_back_when_an_axis_is_connected_again(void)
{
    move(5);
    axis_simulate(&bench.axis, true);
    move(7);
    axis_set_position(&bench.axis, 1000);

    axis_simulate(&bench.axis, false);

    TEST_ASSERT_EQUAL_INT64(5, axis_position_steps(&bench.axis));
}

void test_an_axis_that_is_disconnected_twice_goes_back_to_where_it_first_was(void)
{
    move(5);
    axis_simulate(&bench.axis, true);
    move(7);
    axis_simulate(&bench.axis, true);

    axis_simulate(&bench.axis, false);
    axis_simulate(&bench.axis, false);
    move(1);

    TEST_ASSERT_EQUAL_INT64(6, axis_position_steps(&bench.axis));
}
