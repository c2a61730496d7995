/* What an early end leaves of a motion, and going on with it. */
#include "axis_bench.h"
#include "base_tick.h"
#include "hal_time.h"
#include "unity.h"

static struct axis_bench bench;

/* What stands after the last section is not of the order. */
static const struct motion_order two_sections = {
    .section = {{300, 1000, 60000}, {200, 500, 60000}, {7, 500, 60000}},
    .start_speed_steps_per_s = 100,
    .sections = 2,
};

static const struct motion_order four_sections = {
    .section = {{100, 1000, 60000}, {200, 500, 50000}, {300, 600, 40000}, {400, 700, 30000}},
    .start_speed_steps_per_s = 100,
    .sections = 4,
};

static struct motion_order endless_order(void)
{
    return (struct motion_order){
        .section = {motion_order_endless(100, 2000)},
        .start_speed_steps_per_s = 100,
        .sections = 1,
    };
}

void setUp(void)
{
    axis_bench_init(&bench);
}

void tearDown(void)
{
    axis_bench_check(&bench);
}

static const struct axis_guards no_guards = {0};

static void begin(const struct motion_order *order)
{
    axis_bench_start(&bench, order, (struct axis_guards){0}, 0);
}

static void pause_at(uint64_t ms)
{
    axis_bench_run_until(&bench, ms * TICKS_PER_MS);
    TEST_ASSERT_TRUE(axis_stop(&bench.axis, AXIS_CAUSE_PAUSE));
    axis_bench_run(&bench);
}

static void go_on(void)
{
    bench.machine.enabled_tick = TICK_NEVER;
    axis_go_on(&bench.axis, hal_time_now());
    TEST_ASSERT_EQUAL_UINT64(bench.machine.now, bench.machine.enabled_tick);
}

void test_a_motion_that_is_gone_on_with_ends_where_it_would_have(void)
{
    begin(&two_sections);
    pause_at(150);
    TEST_ASSERT_TRUE(axis_has_rest(&bench.axis));
    TEST_ASSERT_TRUE(axis_position_steps(&bench.axis) < 300);

    go_on();
    axis_bench_run(&bench);

    TEST_ASSERT_FALSE(axis_has_rest(&bench.axis));
    TEST_ASSERT_EQUAL_INT64(500, axis_position_steps(&bench.axis));
}

void test_a_rest_of_the_last_section_marks_that_it_begins(void)
{
    begin(&two_sections);
    TEST_ASSERT_FALSE(axis_take_mark(&bench.axis));
    pause_at(450);
    TEST_ASSERT_TRUE(axis_position_steps(&bench.axis) > 300);
    (void)axis_take_mark(&bench.axis);

    go_on();

    TEST_ASSERT_TRUE(axis_take_mark(&bench.axis));
    TEST_ASSERT_FALSE(axis_take_mark(&bench.axis));
    axis_bench_run(&bench);
    TEST_ASSERT_EQUAL_INT64(500, axis_position_steps(&bench.axis));
}

void test_a_motion_can_be_paused_and_gone_on_with_many_times(void)
{
    uint64_t ms = 0;
    begin(&two_sections);
    for (unsigned i = 0; i < 5; i++) {
        ms += 120;
        pause_at(ms);
        ms = bench.machine.now / TICKS_PER_MS + 1U;
        go_on();
    }
    axis_bench_run(&bench);

    TEST_ASSERT_EQUAL_INT64(500, axis_position_steps(&bench.axis));
}

void test_a_run_without_end_is_always_left(void)
{
    const struct motion_order endless = endless_order();
    begin(&endless);
    pause_at(500);

    TEST_ASSERT_TRUE(axis_has_rest(&bench.axis));
    TEST_ASSERT_TRUE(axis_is_jog(&bench.axis));
}

void test_what_is_forgotten_is_not_left(void)
{
    const struct motion_order endless = endless_order();
    begin(&endless);
    pause_at(500);

    axis_forget(&bench.axis);

    TEST_ASSERT_FALSE(axis_has_rest(&bench.axis));
}

void test_a_motion_that_has_come_to_its_end_leaves_nothing(void)
{
    begin(&two_sections);
    axis_bench_run(&bench);

    TEST_ASSERT_FALSE(axis_has_rest(&bench.axis));
}

void test_a_stop_is_told_to_be_the_reason_only_once(void)
{
    begin(&two_sections);
    axis_bench_run_until(&bench, 100 * TICKS_PER_MS);

    TEST_ASSERT_TRUE(axis_stop(&bench.axis, AXIS_CAUSE_PAUSE));
    TEST_ASSERT_FALSE(axis_stop(&bench.axis, AXIS_CAUSE_COMMAND));

    axis_bench_run(&bench);
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_PAUSE, axis_cause(&bench.axis));
}

void test_the_end_of_a_motion_is_taken_once(void)
{
    begin(&two_sections);
    TEST_ASSERT_TRUE(axis_is_busy(&bench.axis));
    TEST_ASSERT_FALSE(axis_take_end(&bench.axis));
    axis_bench_run(&bench);

    TEST_ASSERT_FALSE(axis_is_busy(&bench.axis));
    TEST_ASSERT_FALSE(axis_take_end(&bench.axis));
}

void test_a_motion_tells_the_steps_that_are_ordered_and_those_that_are_made(void)
{
    begin(&two_sections);
    axis_bench_assert_motion(&bench, HAL_TRACE_MOVE, 500, 0);

    axis_bench_run(&bench);

    axis_bench_assert_motion(&bench, HAL_TRACE_DONE, 500, bench.last_edge_tick);
}

void test_steps_backward_are_told_as_negative(void)
{
    axis_begin(&bench.axis, &two_sections, true, bench.machine.epoch, &no_guards);
    axis_bench_assert_motion(&bench, HAL_TRACE_MOVE, -500, 0);

    axis_bench_run(&bench);

    axis_bench_assert_motion(&bench, HAL_TRACE_DONE, -500, bench.last_edge_tick);
}

void test_a_run_without_end_tells_0_steps_as_it_begins(void)
{
    const struct motion_order endless = endless_order();
    begin(&endless);
    axis_bench_assert_motion(&bench, HAL_TRACE_MOVE, 0, 0);

    pause_at(500);

    axis_bench_assert_motion(&bench, HAL_TRACE_DONE, axis_position_steps(&bench.axis), bench.last_edge_tick);
}

void test_a_rest_backward_goes_on_backward_and_tells_what_is_left(void)
{
    axis_begin(&bench.axis, &two_sections, true, bench.machine.epoch, &no_guards);
    pause_at(150);
    int64_t made = axis_position_steps(&bench.axis);
    TEST_ASSERT_TRUE(made < 0 && made > -300);

    uint64_t now = hal_time_now();
    axis_go_on(&bench.axis, now);
    axis_bench_assert_motion(&bench, HAL_TRACE_MOVE, -500 - made, now - bench.machine.epoch);
    axis_bench_run(&bench);

    TEST_ASSERT_EQUAL_INT64(-500, axis_position_steps(&bench.axis));
}

void test_a_rest_is_the_sections_that_have_not_been_made(void)
{
    begin(&four_sections);
    pause_at(250);
    int64_t made = axis_position_steps(&bench.axis);
    TEST_ASSERT_TRUE(made > 100 && made < 300);

    const struct motion_order *rest = &bench.axis.order;
    TEST_ASSERT_EQUAL_UINT8(3, rest->sections);
    TEST_ASSERT_EQUAL_UINT64(300 - made, rest->section[0].steps);
    TEST_ASSERT_EQUAL_UINT32(500, rest->section[0].speed_steps_per_s);
    TEST_ASSERT_EQUAL_UINT64(300, rest->section[1].steps);
    TEST_ASSERT_EQUAL_UINT32(40000, rest->section[1].accel_steps_per_s2);
    TEST_ASSERT_EQUAL_UINT64(400, rest->section[2].steps);
    TEST_ASSERT_EQUAL_UINT32(700, rest->section[2].speed_steps_per_s);
}

void test_a_limit_run_or_a_move_with_an_end_is_no_jog(void)
{
    const struct motion_order endless = endless_order();
    axis_bench_start(&bench, &endless, (struct axis_guards){.halt_high = 1}, 0);
    TEST_ASSERT_FALSE(axis_is_jog(&bench.axis));
    pause_at(100);

    axis_begin(&bench.axis, &two_sections, false, hal_time_now(), &no_guards);
    TEST_ASSERT_FALSE(axis_is_jog(&bench.axis));
    axis_bench_run(&bench);
}
