/* K and C75 in every state of a program (spec, section 5.5). */
#include <string.h>

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

/* A motor in cruise at V1000, 247.5 steps away from a stand. */
static void arrange_cruise(const char *rest)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R");
    bench_send(&bench, 1, rest);
    bench_run_pulses(&bench, 1, 700);
}

void test_k_stops_down_the_ramp(void)
{
    arrange_cruise("F1");
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_UINT32(700 + 1 + 247, bench_pulses(&bench, 1));
}

void test_k_is_traced_once_with_its_cause(void)
{
    arrange_cruise("F1");
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_STOP));
    TEST_ASSERT_EQUAL_INT64(AXIS_CAUSE_PAUSE, bench_event(&bench, 1, HAL_TRACE_STOP, 0)->value);
}

void test_after_k_the_program_does_not_go_on(void)
{
    arrange_cruise("T01");
    bench_do(&bench, 1, "K");
    bench_run_ms(&bench, 5000);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_INT(INTERPRETER_STOPPED, bench_state(&bench, 1));
}

void test_c75_makes_the_steps_that_were_left_and_then_the_program(void)
{
    arrange_cruise("T01");
    bench_do(&bench, 1, "K");
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_INT64(2000, bench_position(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_the_rest_is_a_move_of_its_own_that_begins_at_c75(void)
{
    arrange_cruise("T01");
    bench_do(&bench, 1, "K");
    uint64_t resumed = bench_now(&bench);
    bench_do(&bench, 1, "C75");
    const struct bench_event *move = bench_event(&bench, 1, HAL_TRACE_MOVE, 1);
    TEST_ASSERT_EQUAL_INT64(2000 - 948, move->value);
    TEST_ASSERT_EQUAL_UINT64(resumed, move->tick);
}

void test_k_and_c75_again_and_again_lose_no_step(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 B2000 R T01");
    for (uint32_t pulse = 100; pulse < 1900; pulse += 300) {
        bench_run_pulses(&bench, 1, pulse);
        bench_do(&bench, 1, "K");
        bench_send(&bench, 1, "C75");
    }
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_INT64(-2000, bench_position(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(2000, bench_pulses(&bench, 1));
}

void test_k_at_every_pulse_of_a_move_loses_no_step(void)
{
    for (uint32_t pulse = 1; pulse < 60; pulse++) {
        bench_init(&bench);
        bench_send(&bench, 1, "S100 V700 A9000 F60 R");
        bench_run_pulses(&bench, 1, pulse);
        bench_do(&bench, 1, "K");
        bench_do(&bench, 1, "C75");
        TEST_ASSERT_EQUAL_INT64(60, bench_position(&bench, 1));
        bench_check(&bench);
    }
}

void test_c75_while_the_motor_brakes_goes_on_when_it_stands(void)
{
    arrange_cruise("T01");
    bench_send(&bench, 1, "K");
    bench_run_ms(&bench, 100);
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_INT64(2000, bench_position(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(2, bench_count(&bench, 1, HAL_TRACE_MOVE));
}

void test_k_takes_back_a_c75_that_waits_for_the_motor_to_stand(void)
{
    arrange_cruise("T01");
    bench_send(&bench, 1, "K");
    bench_run_ms(&bench, 100);
    bench_send(&bench, 1, "C75");
    bench_run_ms(&bench, 100);
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_INT(INTERPRETER_STOPPED, bench_state(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(948, bench_position(&bench, 1));
}

TEST_CASE("S100 V1000 A2000 M03 F2000 R T01", 700)
TEST_CASE("S100 V1000 A2000 )03 T01", 5)
void test_c75_while_the_motor_brakes_passes_over_a_rest_that_an_input_forbids(const char *text, unsigned pulses)
{
    bench_send(&bench, 1, text);
    bench_run_pulses(&bench, 1, pulses);
    bench_send(&bench, 1, "K");
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_UINT32(2, bench_count(&bench, 1, HAL_TRACE_DONE));
    TEST_ASSERT_EQUAL_INT64(0, bench_event(&bench, 1, HAL_TRACE_DONE, 1)->value);
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_nothing_is_left_of_a_move_that_k_finds_on_its_last_ramp(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R T01");
    bench_run_pulses(&bench, 1, 1900);
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_INT64(2000, bench_position(&bench, 1));
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_MOVE));
}

void test_nothing_is_left_of_a_move_that_a_guard_was_stopping(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 M03 F2000 R T01");
    bench_run_pulses(&bench, 1, 700);
    bench_set_input(&bench, 3, true);
    bench_run_ms(&bench, 50);
    bench_do(&bench, 1, "K");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_MOVE));
}

void test_the_guards_are_as_they_were_after_c75(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 M03 F2000 R");
    bench_run_pulses(&bench, 1, 200);
    bench_do(&bench, 1, "K");
    uint32_t made = bench_pulses(&bench, 1);
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_UINT32(made, bench_pulses(&bench, 1));
}

void test_an_endless_run_is_endless_again_after_c75(void)
{
    bench_send(&bench, 1, "S1000 G-");
    bench_run_pulses(&bench, 1, 50);
    bench_do(&bench, 1, "K");
    bench_send(&bench, 1, "C75");
    bench_run_ms(&bench, 30000);
    TEST_ASSERT_INT64_WITHIN(2, -30050, bench_position(&bench, 1));
    bench_do(&bench, 1, "K");
}

void test_a_limit_run_is_a_limit_run_again_after_c75(void)
{
    bench_send(&bench, 1, "S1000 )05 T01");
    bench_run_pulses(&bench, 1, 50);
    bench_do(&bench, 1, "K");
    bench_send(&bench, 1, "C75");
    bench_run_ms(&bench, 100);
    bench_set_input(&bench, 5, true);
    bench_run_idle(&bench);
    TEST_ASSERT_INT64_WITHIN(2, 150, bench_position(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_a_compound_move_goes_on_in_the_section_where_k_stopped_it(void)
{
    bench_send(&bench, 1, "S100 A2000 V500 F300 Y V1000 F900 Y V300 F200 Y R");
    bench_run_pulses(&bench, 1, 600);
    bench_do(&bench, 1, "K");
    uint32_t made = bench_pulses(&bench, 1);
    TEST_ASSERT_GREATER_THAN_UINT32(600, made);
    TEST_ASSERT_LESS_THAN_UINT32(1200, made);
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_INT64(1400, bench_position(&bench, 1));
    uint64_t last = bench_pulse_tick(&bench, 1, 1300) - bench_pulse_tick(&bench, 1, 1299);
    TEST_ASSERT_UINT64_WITHIN(2, TICK_HZ / 300U, last);
}

void test_k_in_a_wait_keeps_the_time_that_was_left(void)
{
    bench_send(&bench, 1, "W1000 T01");
    bench_run_ms(&bench, 300);
    bench_do(&bench, 1, "K");
    bench_run_ms(&bench, 5000);
    uint64_t resumed = bench_now(&bench);
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_UINT64(resumed + 700 * TICKS_PER_MS, bench_event(&bench, 1, HAL_TRACE_OUT, 0)->tick);
}

void test_k_in_a_wait_for_an_input_waits_again_after_c75(void)
{
    bench_send(&bench, 1, "O03 T01");
    bench_run_ms(&bench, 10);
    bench_send(&bench, 1, "K");
    bench_set_input(&bench, 3, true);
    bench_set_input(&bench, 3, false);
    bench_send(&bench, 1, "C75");
    bench_run_ms(&bench, 10);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_k_in_a_wait_for_an_input_does_not_see_it(void)
{
    bench_send(&bench, 1, "O03 T01");
    bench_run_ms(&bench, 10);
    bench_send(&bench, 1, "K");
    bench_set_input(&bench, 3, true);
    bench_run_ms(&bench, 10);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_k_stops_a_program_that_loops_without_waiting(void)
{
    bench_send(&bench, 1, "@1 T80 C80 J1");
    bench_run_ms(&bench, 5);
    bench_do(&bench, 1, "K");
    uint32_t writes = bench_count(&bench, 1, HAL_TRACE_VAR);
    bench_run_ms(&bench, 5);
    TEST_ASSERT_EQUAL_UINT32(writes, bench_count(&bench, 1, HAL_TRACE_VAR));
    bench_send(&bench, 1, "C75");
    bench_run_ms(&bench, 5);
    TEST_ASSERT_GREATER_THAN_UINT32(writes, bench_count(&bench, 1, HAL_TRACE_VAR));
}

TEST_CASE("W10")
TEST_CASE("[ W1")
void test_while_stopped_new_commands_are_stored_and_wait(const char *before)
{
    bench_send(&bench, 1, before);
    bench_run_ms(&bench, 5);
    bench_send(&bench, 1, "K");
    bench_do(&bench, 1, "] T01");
    bench_run_ms(&bench, 100);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_what_waited_while_stopped_begins_at_c75(void)
{
    bench_send(&bench, 1, "O03");
    bench_run_ms(&bench, 5);
    bench_send(&bench, 1, "K");
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, "S1000 F1 R");
    bench_run_ms(&bench, 500);
    uint64_t resumed = bench_now(&bench);
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_UINT64(resumed + TICKS_PER_MS, bench_pulse_tick(&bench, 1, 1));
}

/* Rest: nothing has come yet, all has run, and the very pass in which the last of it has. */
TEST_CASE("", 0)
TEST_CASE("T02", 10)
TEST_CASE("S1000 F5 R", 10)
TEST_CASE("S1000 F5 R", 5)
TEST_CASE("W5", 5)
TEST_CASE("\\", 0)
void test_k_to_a_motor_at_rest_does_nothing(const char *before, unsigned ms)
{
    bench_send(&bench, 1, before);
    bench_run_ticks(&bench, ms * TICKS_PER_MS + 1);
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(&bench, 1, "K"));
    bench_do(&bench, 1, "T01 S1000 F3 R");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_STOP));
    TEST_ASSERT_EQUAL_INT(INTERPRETER_IDLE, bench_state(&bench, 1));
}

void test_k_before_the_commands_that_have_just_come_stops_them(void)
{
    bench_send(&bench, 1, "T01");
    bench_do(&bench, 1, "K");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_c75_after_k_at_rest_has_no_effect(void)
{
    bench_do(&bench, 1, "S1000 F5 R");
    bench_do(&bench, 1, "K");
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_MOVE));
    TEST_ASSERT_EQUAL_INT(INTERPRETER_IDLE, bench_state(&bench, 1));
}

void test_k_while_held_keeps_the_hold(void)
{
    bench_do(&bench, 1, "[ T01");
    bench_do(&bench, 1, "K");
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_INT(INTERPRETER_HELD, bench_state(&bench, 1));
}

void test_k_while_stopped_changes_nothing(void)
{
    arrange_cruise("T01");
    bench_do(&bench, 1, "K");
    bench_do(&bench, 1, "K");
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_INT64(2000, bench_position(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_STOP));
}

void test_k_after_the_end_by_x_changes_nothing(void)
{
    bench_send(&bench, 1, "X03 W1000");
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_INT(INTERPRETER_ENDED, bench_state(&bench, 1));
}

void test_k_after_an_error_changes_nothing(void)
{
    bench_do(&bench, 1, "E");
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_INT(INTERPRETER_FAILED, bench_state(&bench, 1));
}

TEST_CASE("W1000 T01")
TEST_CASE("O03 T01")
TEST_CASE("[ T01")
TEST_CASE("X04 E T01")
void test_c75_has_no_effect_after_anything_but_k(const char *text)
{
    bench_send(&bench, 1, text);
    bench_run_ms(&bench, 10);
    enum interpreter_state state = bench_state(&bench, 1);
    bench_send(&bench, 1, "C75");
    bench_run_ms(&bench, 10);
    TEST_ASSERT_EQUAL_INT(state, bench_state(&bench, 1));
}

void test_c75_during_a_move_has_no_effect(void)
{
    bench_send(&bench, 1, "S1000 F100 R");
    bench_run_pulses(&bench, 1, 50);
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_UINT32(100, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_MOVE));
}

void test_k_with_blanks_and_comments_is_alone(void)
{
    arrange_cruise("W1");
    bench_do(&bench, 1, " {stop} K\r\n{now}");
    TEST_ASSERT_EQUAL_INT(INTERPRETER_STOPPED, bench_state(&bench, 1));
}

TEST_CASE("K T02")
TEST_CASE("T02 K")
TEST_CASE("K K")
TEST_CASE("C75 T02")
TEST_CASE("K C75")
void test_k_and_c75_in_a_longer_message_are_ignored(const char *text)
{
    bench_send(&bench, 1, "S1000 F100 R");
    bench_run_pulses(&bench, 1, 50);
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(&bench, 1, text));
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(100, bench_pulses(&bench, 1));
    TEST_ASSERT_NULL(strchr(bench_ask(&bench, 5, 1), 'K'));
    TEST_ASSERT_NULL(strstr(bench_ask(&bench, 5, 1), "C75"));
}

void test_k_for_all_motors_stops_all(void)
{
    bench_send(&bench, 0, "S1000 G+");
    bench_run_ms(&bench, 50);
    bench_do(&bench, 0, "K");
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_INT(INTERPRETER_STOPPED, bench_state(&bench, motor));
    }
}
