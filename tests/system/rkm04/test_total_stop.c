/* X in every state of a program (spec, sections 4, 5.3 and 5.5). */
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

static void assert_ended(void)
{
    TEST_ASSERT_EQUAL_INT(INTERPRETER_ENDED, bench_state(&bench, 1));
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_END));
}

void test_x_stops_a_move_down_its_ramp_and_ends_the_program(void)
{
    bench_send(&bench, 1, "X03 S100 V1000 A2000 F2000 R T01");
    bench_run_pulses(&bench, 1, 700);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(700 + 1 + 247, bench_pulses(&bench, 1));
    assert_ended();
}

void test_x_during_a_move_is_traced_once(void)
{
    bench_send(&bench, 1, "X03 S100 V1000 A2000 F2000 R T01");
    bench_run_pulses(&bench, 1, 700);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_STOP));
    TEST_ASSERT_EQUAL_INT64(AXIS_CAUSE_ABORT, bench_event(&bench, 1, HAL_TRACE_STOP, 0)->value);
}

void test_a_short_pulse_of_x_ends_the_program(void)
{
    bench_send(&bench, 1, "X03 S100 V1000 A2000 F2000 R T01");
    bench_plan_input(&bench, 500 * TICKS_PER_MS, 3, true);
    bench_plan_input(&bench, 500 * TICKS_PER_MS + 10, 3, false);
    bench_run_idle(&bench);
    assert_ended();
}

void test_x_ends_a_program_that_a_guard_is_stopping(void)
{
    bench_send(&bench, 1, "X03 M04 S100 V1000 A2000 F2000 R T01");
    bench_run_pulses(&bench, 1, 700);
    bench_set_input(&bench, 4, true);
    bench_run_ms(&bench, 50);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    assert_ended();
    TEST_ASSERT_EQUAL_INT64(AXIS_CAUSE_ABORT, bench_event(&bench, 1, HAL_TRACE_STOP, 1)->value);
}

void test_x_ends_a_limit_run(void)
{
    bench_send(&bench, 1, "X03 S1000 )05 T01");
    bench_run_pulses(&bench, 1, 50);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_UINT32_WITHIN(1, 50, bench_pulses(&bench, 1));
    assert_ended();
}

TEST_CASE("X03 W1000 T01")
TEST_CASE("X03 O05 T01")
TEST_CASE("X03 [ T01")
TEST_CASE("X03 @1 V5 J1")
TEST_CASE("X03 S1000 F500 R W1000 T01")
void test_x_ends_a_program_that_waits_or_runs(const char *text)
{
    bench_send(&bench, 1, text);
    bench_run_ms(&bench, 700);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    bench_send(&bench, 1, "]");
    bench_run_ms(&bench, 2000);
    assert_ended();
    TEST_ASSERT_EQUAL_INT64(AXIS_CAUSE_ABORT, bench_event(&bench, 1, HAL_TRACE_STOP, 0)->value);
}

/* At rest before there was a move, and after one that X has watched. */
TEST_CASE("X03")
TEST_CASE("X03 S1000 F5 R")
TEST_CASE("X03 W5")
void test_a_short_x_while_the_motor_rests_does_nothing(const char *text)
{
    bench_do(&bench, 1, text);
    bench_run_ms(&bench, 10);
    bench_set_input(&bench, 3, true);
    bench_run_ms(&bench, 10);
    bench_set_input(&bench, 3, false);
    bench_do(&bench, 1, "T01 S1000 F7 B7 R");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(-7,
                            bench_event(&bench, 1, HAL_TRACE_DONE, bench_count(&bench, 1, HAL_TRACE_DONE) - 1U)->value);
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_STOP));
}

void test_x_that_is_still_1_acts_before_the_first_new_command(void)
{
    bench_do(&bench, 1, "X03");
    bench_set_input(&bench, 3, true);
    bench_run_ms(&bench, 10);
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_STOP));
    bench_do(&bench, 1, "T01 T02");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_INT(INTERPRETER_ENDED, bench_state(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_STOP));
}

void test_a_guard_of_x_stays_for_the_moves_after_a_rest(void)
{
    bench_do(&bench, 1, "X03");
    bench_set_input(&bench, 3, true);
    bench_set_input(&bench, 3, false);
    bench_send(&bench, 1, "S1000 F500 R T01");
    bench_run_pulses(&bench, 1, 50);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_INT(INTERPRETER_ENDED, bench_state(&bench, 1));
}

void test_x_ends_a_program_that_k_has_stopped(void)
{
    bench_send(&bench, 1, "X03 S1000 F500 R T01");
    bench_run_pulses(&bench, 1, 50);
    bench_do(&bench, 1, "K");
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, "C75");
    assert_ended();
}

void test_x_ends_a_program_that_k_is_stopping(void)
{
    bench_send(&bench, 1, "X03 S100 V1000 A2000 F2000 R T01");
    bench_run_pulses(&bench, 1, 700);
    bench_send(&bench, 1, "K");
    bench_send(&bench, 1, "C75");
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(948, bench_pulses(&bench, 1));
    assert_ended();
}

void test_x_that_is_1_when_it_is_set_ends_the_program_at_once(void)
{
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, "X03 S1000 F5 T01 R");
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
    assert_ended();
}

TEST_CASE(2)
TEST_CASE(3)
void test_several_inputs_may_be_set(unsigned input)
{
    bench_send(&bench, 1, "X02 X03 W1000 T01");
    bench_run_ms(&bench, 10);
    bench_set_input(&bench, (uint8_t)input, true);
    bench_run_idle(&bench);
    assert_ended();
}

void test_another_input_does_nothing(void)
{
    bench_set_input(&bench, 4, true);
    bench_do(&bench, 1, "X03 W10 T01");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_u_does_not_cancel_x(void)
{
    bench_send(&bench, 1, "X03 U W1000 T01");
    bench_run_ms(&bench, 10);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    assert_ended();
}

void test_x_stays_set_after_a_move(void)
{
    bench_send(&bench, 1, "X03 S1000 F5 R R W1000 T01");
    bench_run_ms(&bench, 50);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    assert_ended();
}

void test_a_reset_cancels_x(void)
{
    bench_do(&bench, 1, "X03 \\ T80");
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, "T01");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_x_does_not_end_what_follows_a_reset(void)
{
    bench_send(&bench, 1, "X03 S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_send(&bench, 1, "\\ T01");
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_a_reset_makes_the_motor_run_again_after_x(void)
{
    bench_send(&bench, 1, "X03 S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_set_input(&bench, 3, true);
    bench_send(&bench, 1, "\\ T01");
    bench_run_idle(&bench);
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

TEST_CASE("T01")
TEST_CASE("C75")
TEST_CASE("]")
TEST_CASE("V500")
void test_after_x_commands_are_stored_and_wait(const char *text)
{
    bench_send(&bench, 1, "X03 W1000");
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, text);
    bench_set_input(&bench, 3, false);
    bench_run_ms(&bench, 2000);
    assert_ended();
}

void test_x_of_one_motor_does_not_end_the_others(void)
{
    bench_send(&bench, 1, "X03 W100");
    bench_send(&bench, 2, "W100 T02");
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_TRUE(bench_output(&bench, 2));
}
