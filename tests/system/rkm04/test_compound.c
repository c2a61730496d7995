/* Compound moves: Y, R, D and T51 to T58 (spec, sections 4, 5.7 and 7). */
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

/* The parameter is what is sent after S1000; V is the start value or lower, so all is at constant speed. */
TEST_CASE("F5 Y F6 Y R", 11)
TEST_CASE("B5 Y B6 Y R", -11)
TEST_CASE("F5 Y Y Y R", 15)
TEST_CASE("F5 Y R R", 10)
TEST_CASE("F5 Y Y R D R", 0)
TEST_CASE("F5 Y Y R D R R", -10)
TEST_CASE("F5 Y R F2 R", 7)
TEST_CASE("F5 Y R B2 R", 3)
TEST_CASE("F5 Y F2 R R", 10)
TEST_CASE("F5 Y R F2 Y R", 7)
TEST_CASE("F5 Y R Y Y R", 15)
TEST_CASE("F5 Y R D Y R", 0)
TEST_CASE("F5 Y R B2 Y R", 3)
TEST_CASE("F5 Y G3 R", 8)
TEST_CASE("F5 Y D R", -5)
TEST_CASE("F5 Y D R D R", 0)
TEST_CASE("F5 Y D D Y R", 10)
TEST_CASE("F5 Y B2 R", 5)
void test_a_compound_move_is_made(const char *text, int position)
{
    bench_send(&bench, 1, "S1000");
    bench_do(&bench, 1, text);
    TEST_ASSERT_EQUAL_INT64(position, bench_position(&bench, 1));
}

void test_a_compound_move_is_one_move(void)
{
    bench_do(&bench, 1, "S1000 F5 Y F6 Y R");
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_MOVE));
    TEST_ASSERT_EQUAL_INT64(11, bench_event(&bench, 1, HAL_TRACE_MOVE, 0)->value);
}

void test_steps_and_v_are_those_of_each_y(void)
{
    bench_do(&bench, 1, "S1000 A60000 V500 F5 Y V250 F6 Y V800 R");
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 500U, bench_pulse_tick(&bench, 1, 3) - bench_pulse_tick(&bench, 1, 2));
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 250U, bench_pulse_tick(&bench, 1, 8) - bench_pulse_tick(&bench, 1, 7));
}

void test_s_is_the_one_in_force_at_r(void)
{
    bench_do(&bench, 1, "S10 V500 A1 F5 Y Y S1000 R");
    TEST_ASSERT_EQUAL_UINT64(TICK_HZ / 500U, bench_pulse_tick(&bench, 1, 1));
}

/* Section 1 ends at the speed of 500 that S allows; its acceleration is that of its Y. */
void test_a_is_the_one_of_each_y(void)
{
    bench_do(&bench, 1, "S100 V500 A60000 F100 Y A100 Y R");
    TEST_ASSERT_UINT64_WITHIN(2, TICK_HZ / 500U, bench_pulse_tick(&bench, 1, 50) - bench_pulse_tick(&bench, 1, 49));
}

void test_ten_sections_are_allowed(void)
{
    bench_do(&bench, 1, "S1000 F5 Y Y Y Y Y Y Y Y Y Y R");
    TEST_ASSERT_EQUAL_INT64(50, bench_position(&bench, 1));
}

void test_ten_sections_of_the_longest_are_allowed(void)
{
    bench_send(&bench, 1, "V16000 A60000 F16000000 Y Y Y Y Y Y Y Y Y Y R");
    bench_run_ms(&bench, 100);
    TEST_ASSERT_EQUAL_INT64(160000000, bench_event(&bench, 1, HAL_TRACE_MOVE, 0)->value);
    bench_do(&bench, 1, "K");
}

void test_an_eleventh_section_is_an_error(void)
{
    bench_do(&bench, 1, "S1000 F5 Y Y Y Y Y Y Y Y Y Y Y R");
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(INTERPRETER_ERROR_SECTIONS, bench_event(&bench, 1, HAL_TRACE_ERROR, 0)->value);
}

TEST_CASE("F5 Y D Y R")
TEST_CASE("F5 Y B5 Y R")
TEST_CASE("B5 Y F5 Y R")
TEST_CASE("F100 Y D F100 Y R")
void test_a_change_of_direction_inside_is_an_error(const char *text)
{
    bench_do(&bench, 1, text);
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(INTERPRETER_ERROR_DIRECTION, bench_event(&bench, 1, HAL_TRACE_ERROR, 0)->value);
}

void test_y_without_steps_is_an_error(void)
{
    bench_do(&bench, 1, "Y");
    TEST_ASSERT_EQUAL_INT64(INTERPRETER_ERROR_NO_STEPS, bench_event(&bench, 1, HAL_TRACE_ERROR, 0)->value);
}

/* On at the first Y, but not any more when the last section begins: one section or two, run again, by another T. */
TEST_CASE("T52 F10 Y Y R C52 C02 W5 R W5", "R")
TEST_CASE("T52 F10 Y Y C52 R", "R")
TEST_CASE("T52 F10 Y C52 R", "R")
TEST_CASE("T52 F10 Y C52 T53 R", "R")
TEST_CASE("F10 T52 Y C52 Y T51 T53 R", "")
void test_no_output_is_set_by_a_function_that_has_been_switched_off(const char *text, const char *again)
{
    bench_send(&bench, 1, "[ S500 V500 A2000");
    bench_send(&bench, 1, text);
    bench_send(&bench, 1, again);
    bench_do(&bench, 1, "]");
    TEST_ASSERT_EQUAL_HEX8(0x00, bench.machine.outputs);
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_ERROR));
}

TEST_CASE("T52 T53 F10 Y Y C53 R", 0x02)
TEST_CASE("T52 F10 Y Y C52 T52 R", 0x02)
TEST_CASE("T52 F10 Y C52 T52 R", 0x02)
TEST_CASE("F10 Y T52 Y R", 0x00)
void test_what_counts_is_on_at_the_first_y_and_when_the_last_section_begins(const char *text, unsigned outputs)
{
    bench_send(&bench, 1, "[ S500 V500 A2000");
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "]");
    TEST_ASSERT_EQUAL_HEX8(outputs, bench.machine.outputs);
}

/* K in the first section; what is left is a move of its own, and its last section begins in it. */
void test_a_function_switched_on_by_the_first_y_counts_after_k_and_c75(void)
{
    bench_send(&bench, 1, "S500 V500 A2000 T52 F50 Y Y R");
    bench_run_pulses(&bench, 1, 20);
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_HEX8(0x00, bench.machine.outputs);
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_HEX8(0x02, bench.machine.outputs);
}

/* The last section begins when the step before it has been made. */
TEST_CASE("T51", 1)
TEST_CASE("T55", 5)
TEST_CASE("T58", 8)
void test_an_output_is_set_when_the_last_section_begins(const char *text, unsigned output)
{
    bench_send(&bench, 1, text);
    bench_send(&bench, 1, "S1000 F20 Y Y Y R");
    bench_run_pulses(&bench, 1, 39);
    TEST_ASSERT_FALSE(bench_output(&bench, output));
    bench_run_idle(&bench);
    TEST_ASSERT_TRUE(bench_output(&bench, output));
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS, bench_pulse_tick(&bench, 1, 40),
                              bench_event(&bench, 1, HAL_TRACE_OUT, 0)->tick);
}

void test_a_compound_move_of_one_section_sets_its_output_at_the_start(void)
{
    bench_do(&bench, 1, "T53 S1000 F20 Y R");
    TEST_ASSERT_EQUAL_UINT64(bench_event(&bench, 1, HAL_TRACE_MOVE, 0)->tick,
                             bench_event(&bench, 1, HAL_TRACE_OUT, 0)->tick);
}

void test_several_outputs_may_be_set(void)
{
    bench_do(&bench, 1, "T51 T53 T58 S1000 F2 Y Y R");
    TEST_ASSERT_EQUAL_HEX8(0x85, bench.machine.outputs);
}

void test_each_run_of_the_compound_move_sets_the_output(void)
{
    bench_do(&bench, 1, "T53 S1000 F2 Y Y R C03 R");
    TEST_ASSERT_TRUE(bench_output(&bench, 3));
}

TEST_CASE("F2 T53 R")
TEST_CASE("F2 Y T53 Y R")
TEST_CASE("T53 C53 F2 Y Y R")
TEST_CASE("T53 F2 R")
TEST_CASE("T53 F2 Y Y R C03 F2 R")
TEST_CASE("T53 F2 Y Y R C03 G50")
void test_the_output_is_not_set(const char *text)
{
    bench_send(&bench, 1, "S1000");
    bench_do(&bench, 1, text);
    TEST_ASSERT_FALSE(bench_output(&bench, 3));
}

TEST_CASE("T53 F2 Y Y R C53")
void test_switching_the_function_off_clears_nothing_that_began(const char *text)
{
    bench_send(&bench, 1, "S1000");
    bench_do(&bench, 1, text);
    TEST_ASSERT_TRUE(bench_output(&bench, 3));
}

void test_the_functions_are_of_the_motor(void)
{
    bench_do(&bench, 1, "T53");
    bench_do(&bench, 2, "S1000 F2 Y Y R");
    TEST_ASSERT_FALSE(bench_output(&bench, 3));
}

void test_the_output_is_set_after_k_and_c75_too(void)
{
    bench_send(&bench, 1, "T53 S1000 F20 Y F20 Y R");
    bench_run_pulses(&bench, 1, 10);
    bench_do(&bench, 1, "K");
    TEST_ASSERT_FALSE(bench_output(&bench, 3));
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_TRUE(bench_output(&bench, 3));
}

void test_the_output_is_set_once_for_all_parts_of_a_move(void)
{
    bench_send(&bench, 1, "T53 S1000 F20 Y F20 Y R");
    bench_run_pulses(&bench, 1, 30);
    bench_do(&bench, 1, "K");
    bench_do(&bench, 2, "C03");
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_INT64(40, bench_position(&bench, 1));
    TEST_ASSERT_FALSE(bench_output(&bench, 3));
}

void test_the_output_is_not_set_if_a_guard_stops_the_move_before_the_last_section(void)
{
    bench_send(&bench, 1, "T53 M03 S1000 F20 Y F20 Y R");
    bench_run_pulses(&bench, 1, 10);
    bench_set_input(&bench, 3, true);
    bench_run_idle(&bench);
    TEST_ASSERT_FALSE(bench_output(&bench, 3));
}

void test_the_output_is_not_set_if_a_guard_allows_no_step(void)
{
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, "T53 M03 S1000 F20 Y R");
    TEST_ASSERT_FALSE(bench_output(&bench, 3));
}
