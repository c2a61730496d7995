/* Jogging: new commands after a run without end that K has stopped (language.md). */
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

/* Jogging; the new command comes after the stop, or while the motor still brakes for `ms`. */
TEST_CASE("G+", "G-", 2000)
TEST_CASE("G+", "G-", 50)
TEST_CASE("G-", "G-", 2000)
TEST_CASE("G-", "G+", 50)
void test_jogging_needs_no_reset(const char *first, const char *second, unsigned ms)
{
    bench_send(&bench, 1, "S100 V1000 A2000");
    bench_send(&bench, 1, first);
    bench_run_ms(&bench, 1000);
    bench_send(&bench, 1, "K");
    bench_run_ms(&bench, ms);
    bench_send(&bench, 1, second);
    bench_run_ms(&bench, 1000 + 450);
    TEST_ASSERT_EQUAL_INT(INTERPRETER_MOVING, bench_state(&bench, 1));
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_UINT32(2, bench_count(&bench, 1, HAL_TRACE_DONE));
    TEST_ASSERT_TRUE(axis_cause(&bench.unit.axis[0]) == AXIS_CAUSE_PAUSE);
}

void test_what_follows_a_jog_begins_when_the_motor_stands(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 G+");
    bench_run_ms(&bench, 1000);
    bench_send(&bench, 1, "K");
    bench_do(&bench, 1, "T01 H");
    uint64_t stood = bench_event(&bench, 1, HAL_TRACE_DONE, 0)->tick;
    TEST_ASSERT_EQUAL_UINT64(stood, bench_event(&bench, 1, HAL_TRACE_MOVE, 1)->tick);
    TEST_ASSERT_EQUAL_INT64(0, bench_position(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

TEST_CASE(50)
TEST_CASE(700000)
void test_what_follows_a_jog_that_stands_begins_at_once(unsigned us)
{
    bench_send(&bench, 1, "S1000 G+");
    bench_run_ms(&bench, 100);
    bench_do(&bench, 1, "K");
    bench_run_ticks(&bench, (uint64_t)us * TICKS_PER_US);
    uint64_t sent = bench_now(&bench);
    bench_do(&bench, 1, "H");
    TEST_ASSERT_EQUAL_UINT64(sent, bench_event(&bench, 1, HAL_TRACE_MOVE, 1)->tick);
}

/* `between` ends the run that K has stopped, before the C75. */
TEST_CASE("T01")
TEST_CASE("V500")
void test_c75_goes_on_with_a_jog_only_until_new_commands_come(const char *between)
{
    bench_send(&bench, 1, "S1000 G+");
    bench_run_ms(&bench, 100);
    bench_do(&bench, 1, "K");
    bench_do(&bench, 1, between);
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_MOVE));
    TEST_ASSERT_EQUAL_INT(INTERPRETER_IDLE, bench_state(&bench, 1));
}

/* What is not stored does not end it. */
TEST_CASE("K K")
TEST_CASE("{ nothing }")
TEST_CASE("K")
void test_what_is_not_a_command_leaves_a_jog_to_c75(const char *between)
{
    bench_send(&bench, 1, "S1000 G+");
    bench_run_ms(&bench, 100);
    bench_do(&bench, 1, "K");
    bench_do(&bench, 1, between);
    bench_send(&bench, 1, "C75");
    bench_run_ms(&bench, 100);
    TEST_ASSERT_EQUAL_INT(INTERPRETER_MOVING, bench_state(&bench, 1));
    bench_do(&bench, 1, "K");
}

/* Not a run without end, or not the last command: what is sent waits for C75. */
TEST_CASE("S1000 F500 R")
TEST_CASE("S1000 )03")
TEST_CASE("S1000 F500 Y Y R")
TEST_CASE("S1000 G+ T02")
TEST_CASE("M08 S1000 G+ W100")
void test_new_commands_wait_after_any_other_move_that_k_has_stopped(const char *text)
{
    bench_send(&bench, 1, text);
    bench_run_ms(&bench, 100);
    bench_do(&bench, 1, "K");
    bench_do(&bench, 1, "T01");
    bench_run_ms(&bench, 100);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_INT(INTERPRETER_STOPPED, bench_state(&bench, 1));
}

void test_new_commands_wait_in_a_pause_after_a_run_without_end(void)
{
    bench_send(&bench, 1, "M03 S1000 G+ W1000");
    bench_run_ms(&bench, 100);
    bench_set_input(&bench, 3, true);
    bench_run_ms(&bench, 100);
    bench_do(&bench, 1, "K");
    bench_do(&bench, 1, "T01");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

/* The second K stops what has come after the run, not the run: that has been ended. */
void test_k_while_a_jog_brakes_keeps_the_new_commands_for_c75(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 G+");
    bench_run_ms(&bench, 1000);
    bench_send(&bench, 1, "K");
    bench_send(&bench, 1, "T01");
    bench_do(&bench, 1, "K");
    bench_run_ms(&bench, 1000);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_send(&bench, 1, "T02");
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 2));
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_MOVE));
}

void test_new_commands_take_back_a_c75_that_waits_for_a_jog_to_stand(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 G+");
    bench_run_ms(&bench, 1000);
    bench_send(&bench, 1, "K");
    bench_send(&bench, 1, "C75");
    bench_do(&bench, 1, "T01");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_MOVE));
    bench_send(&bench, 1, "F2000 R");
    bench_run_ms(&bench, 100);
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_INT(INTERPRETER_STOPPED, bench_state(&bench, 1));
}

/* A guard and K together stop a jog: new commands run all the same, while the motor brakes and after it. */
TEST_CASE(0)
TEST_CASE(2000)
void test_a_jog_that_a_guard_was_stopping_needs_no_reset_either(unsigned ms)
{
    bench_send(&bench, 1, "S100 V1000 A2000 M03 G+");
    bench_run_ms(&bench, 1000);
    bench_set_input(&bench, 3, true);
    bench_run_ms(&bench, 50);
    bench_send(&bench, 1, "K");
    bench_run_ms(&bench, ms);
    bench_do(&bench, 1, "T01");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_x_ends_a_jog_that_k_has_stopped(void)
{
    bench_send(&bench, 1, "X03 S1000 G+");
    bench_run_ms(&bench, 100);
    bench_do(&bench, 1, "K");
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, "T01");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_INT(INTERPRETER_ENDED, bench_state(&bench, 1));
}

void test_a_reset_after_a_jog_is_a_reset(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 G+");
    bench_run_ms(&bench, 1000);
    bench_send(&bench, 1, "K");
    bench_do(&bench, 1, "\\ S1000 F3 R");
    TEST_ASSERT_EQUAL_INT64(3, bench_event(&bench, 1, HAL_TRACE_DONE, 1)->value);
    TEST_ASSERT_EQUAL_INT(INTERPRETER_IDLE, bench_state(&bench, 1));
}
