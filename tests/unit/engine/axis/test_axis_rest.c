/* What an early end leaves of a motion, and going on with it. */
#include "axis_bench.h"
#include "base_tick.h"
#include "hal_time.h"
#include "unity.h"

static struct axis_bench bench;

static const struct motion_order two_sections = {
    .section = {{300, 1000, 60000}, {200, 500, 60000}},
    .start_speed_steps_per_s = 100,
    .sections = 2,
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
    axis_go_on(&bench.axis, hal_time_now());
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
