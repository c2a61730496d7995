/* M, N and U (spec, sections 4 and 5.3). S1000 makes a step a millisecond, and a stop from there takes no way. */
#include "bench.h"
#include "unity.h"

static struct bench bench;

void setUp(void)
{
    bench_init(&bench);
}

void tearDown(void)
{
    bench_check(&bench);
}

TEST_CASE("M03", true)
TEST_CASE("N03", false)
void test_a_guard_stops_the_move_down_its_ramp_and_the_program_continues(const char *text, bool level)
{
    bench_set_input(&bench, 3, !level);
    bench_send(&bench, 1, text);
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R T01");
    bench_run_pulses(&bench, 1, 700);
    bench_set_input(&bench, 3, level);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(948, bench_pulses(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

TEST_CASE("M03", true)
TEST_CASE("N03", false)
void test_a_guard_that_has_its_level_at_the_start_allows_no_step(const char *text, bool level)
{
    bench_set_input(&bench, 3, level);
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "S1000 F20 R T01");
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

TEST_CASE("M03", true)
TEST_CASE("N03", false)
void test_a_guard_that_has_stopped_a_move_is_spent(const char *text, bool level)
{
    bench_set_input(&bench, 3, level);
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "S1000 F20 R R");
    TEST_ASSERT_EQUAL_UINT32(20, bench_pulses(&bench, 1));
}

void test_a_guard_that_has_not_stopped_a_move_stays(void)
{
    bench_send(&bench, 1, "M03 S1000 F20 R R R");
    bench_run_pulses(&bench, 1, 50);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_UINT32_WITHIN(1, 50, bench_pulses(&bench, 1));
}

/* From before the last pulse of the first move until the unit has seen its end. */
TEST_CASE(-1)
TEST_CASE(0)
TEST_CASE(1)
TEST_CASE(200)
void test_a_guard_that_comes_when_a_move_ends_is_there_for_the_next(int after_ticks)
{
    bench_do(&bench, 1, "S1000 F20 R");
    uint64_t last = bench_pulse_tick(&bench, 1, 20);
    bench_init(&bench);
    bench_plan_input(&bench, last + (uint64_t)(int64_t)after_ticks, 3, true);
    bench_do(&bench, 1, "M03 S1000 F20 R R R");
    TEST_ASSERT_EQUAL_UINT32(40, bench_pulses(&bench, 1));
}

void test_a_guard_that_comes_on_the_way_down_is_there_for_the_next_move(void)
{
    bench_send(&bench, 1, "M03 S100 V1000 A2000 F1000 R R R");
    bench_run_pulses(&bench, 1, 990);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(2000, bench_pulses(&bench, 1));
}

void test_only_the_guard_that_has_stopped_the_move_is_spent(void)
{
    bench_set_input(&bench, 3, true);
    bench_set_input(&bench, 4, true);
    bench_send(&bench, 1, "M03 N04 S1000 F20 R R R");
    bench_run_pulses(&bench, 1, 10);
    bench_set_input(&bench, 4, false);
    bench_run_idle(&bench);
    TEST_ASSERT_UINT32_WITHIN(1, 30, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(AXIS_CAUSE_HIGH, bench_event(&bench, 1, HAL_TRACE_STOP, 0)->value);
    TEST_ASSERT_EQUAL_INT64(AXIS_CAUSE_LOW, bench_event(&bench, 1, HAL_TRACE_STOP, 1)->value);
}

/* Input 3 is 1 all the time, input 4 is 0. */
TEST_CASE("M03 M04")
TEST_CASE("N04 N03")
TEST_CASE("M03 U")
TEST_CASE("N04 U")
void test_a_guard_that_was_replaced_or_cancelled_does_nothing(const char *text)
{
    bench_set_input(&bench, 3, true);
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "S1000 F20 R");
    TEST_ASSERT_EQUAL_UINT32(20, bench_pulses(&bench, 1));
}

void test_m_and_n_guard_together(void)
{
    bench_set_input(&bench, 4, true);
    bench_send(&bench, 1, "M03 N04 S1000 F90 R");
    bench_run_pulses(&bench, 1, 20);
    bench_set_input(&bench, 4, false);
    bench_run_idle(&bench);
    TEST_ASSERT_UINT32_WITHIN(1, 20, bench_pulses(&bench, 1));
}

TEST_CASE("R")
TEST_CASE("G+")
TEST_CASE("G-")
TEST_CASE("G90")
TEST_CASE("H")
TEST_CASE("Y Y R")
TEST_CASE(")05")
TEST_CASE("(05")
void test_guards_act_on_every_kind_of_move(const char *move)
{
    bench_send(&bench, 1, "=-90 M03 S1000 F90");
    bench_send(&bench, 1, move);
    bench_send(&bench, 1, "T01");
    bench_run_pulses(&bench, 1, 20);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_UINT32_WITHIN(1, 20, bench_pulses(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

TEST_CASE(1)
TEST_CASE(2)
TEST_CASE(3)
TEST_CASE(4)
void test_guards_act_on_every_motor(unsigned motor)
{
    bench_send(&bench, motor, "M03 S1000 F90 R");
    bench_run_pulses(&bench, motor, 20);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_UINT32_WITHIN(1, 20, bench_pulses(&bench, motor));
}

void test_a_short_pulse_of_a_guard_stops_the_move(void)
{
    bench_send(&bench, 1, "M03 S100 V1000 A2000 F2000 R T01");
    bench_plan_input(&bench, 500 * TICKS_PER_MS, 3, true);
    bench_plan_input(&bench, 500 * TICKS_PER_MS + 10, 3, false);
    bench_run_idle(&bench);
    TEST_ASSERT_LESS_THAN_UINT32(1000, bench_pulses(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_guards_do_not_act_in_a_wait(void)
{
    bench_send(&bench, 1, "M03 W100 T01");
    bench_run_ms(&bench, 10);
    bench_set_input(&bench, 3, true);
    bench_run_ms(&bench, 50);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_STOP));
}

void test_the_program_goes_on_at_the_last_pulse_of_the_stop(void)
{
    bench_send(&bench, 1, "M03 S100 V1000 A2000 F2000 R S1000 F1 R");
    bench_run_pulses(&bench, 1, 700);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT64(TICKS_PER_MS, bench_pulse_tick(&bench, 1, 949) - bench_pulse_tick(&bench, 1, 948));
}
