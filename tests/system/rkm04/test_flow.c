/* The flow of a program (spec, sections 4 and 5.7): jumps, conditions, loops, subroutines, waits for levels. */
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

TEST_CASE("L1 R E", 1)
TEST_CASE("L3 R E", 3)
TEST_CASE("L255 R E", 255)
TEST_CASE("L2 L3 R E R E", 8)
TEST_CASE("L2 L2 L2 L2 L2 L2 L2 L2 R E E E E E E E E", 256)
TEST_CASE("L2 R E L2 R E", 4)
void test_the_body_of_a_loop_runs_so_many_times(const char *text, unsigned passes)
{
    bench_send(&bench, 1, "S2000 V2000 F1");
    bench_do(&bench, 1, text);
    TEST_ASSERT_EQUAL_UINT32(passes, bench_pulses(&bench, 1));
}

void test_a_jump_skips_what_is_between(void)
{
    bench_do(&bench, 1, "J5 T01 @5 T02");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 2));
}

void test_a_jump_back_repeats(void)
{
    bench_send(&bench, 1, "S1000 @80 F1 R J80");
    bench_run_pulses(&bench, 1, 50);
    TEST_ASSERT_EQUAL_UINT32(50, bench_count(&bench, 1, HAL_TRACE_DONE));
}

void test_the_youngest_label_counts(void)
{
    bench_do(&bench, 1, "[ J5 @5 T01 J6 @5 T02 @6 ]");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 2));
}

/* T01 is run if there is no jump. */
TEST_CASE("I05H1", false, true)
TEST_CASE("I05H1", true, false)
TEST_CASE("I05L1", false, false)
TEST_CASE("I05L1", true, true)
void test_a_jump_depends_on_an_input(const char *text, bool level, bool goes_on)
{
    bench_set_input(&bench, 5, level);
    bench_send(&bench, 1, "[");
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "T01 @1 ]");
    TEST_ASSERT_EQUAL(goes_on, bench_output(&bench, 1));
}

TEST_CASE("C81 I81H1", true)
TEST_CASE("T81 I81H1", false)
TEST_CASE("C81 I81L1", false)
TEST_CASE("T81 I81L1", true)
TEST_CASE("T80 C81 T82 I81H1", true)
TEST_CASE("T95 I95H1", false)
void test_a_jump_depends_on_a_variable(const char *text, bool goes_on)
{
    bench_send(&bench, 1, "[");
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "T01 @1 ]");
    TEST_ASSERT_EQUAL(goes_on, bench_output(&bench, 1));
}

void test_a_subroutine_returns_after_its_call(void)
{
    bench_do(&bench, 1, "[ S1000 F1 '3 F10 '3 J9 @3 R . @9 ]");
    TEST_ASSERT_EQUAL_INT64(11, bench_position(&bench, 1));
}

void test_six_levels_of_calls_are_allowed(void)
{
    bench_do(&bench, 1, "[ S1000 F1 '1 J9 @1 '2 R . @2 '3 R . @3 '4 R . @4 '5 R . @5 '6 R . @6 R . @9 ]");
    TEST_ASSERT_EQUAL_INT64(6, bench_position(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_ERROR));
}

TEST_CASE("O03", true)
TEST_CASE("Z03", false)
void test_a_wait_ends_when_the_input_has_the_level(const char *text, bool level)
{
    bench_set_input(&bench, 3, !level);
    bench_send(&bench, 1, text);
    bench_send(&bench, 1, "T01");
    bench_run_ms(&bench, 50);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_set_input(&bench, 3, level);
    bench_run_idle(&bench);
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

TEST_CASE("O83", "T83")
TEST_CASE("T83 Z83", "C83")
void test_a_wait_ends_when_another_motor_writes_the_variable(const char *text, const char *writes)
{
    bench_send(&bench, 1, text);
    bench_send(&bench, 1, "T01");
    bench_run_ms(&bench, 50);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_do(&bench, 4, writes);
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_a_wait_for_a_level_that_is_there_takes_no_time(void)
{
    bench_do(&bench, 1, "S1000 Z03 F1 R");
    TEST_ASSERT_EQUAL_UINT64(TICKS_PER_MS, bench_pulse_tick(&bench, 1, 1));
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_WAIT));
}

void test_outputs_and_variables_are_set_and_cleared(void)
{
    bench_do(&bench, 1, "T01 T08 T80 T95 C01 C80");
    TEST_ASSERT_EQUAL_HEX8(0x80, bench.machine.outputs);
    TEST_ASSERT_EQUAL_HEX16(0x8000, bench.unit.shared.variables);
}

void test_the_place_is_the_ordinal_of_the_command_being_run(void)
{
    bench_send(&bench, 1, "S1000 F1 @1 R W1000 J1");
    bench_run_ms(&bench, 500);
    TEST_ASSERT_EQUAL_STRING("     0; 5", bench_ask(&bench, 7, 1));
}

void test_the_place_counts_from_the_last_reset(void)
{
    bench_send(&bench, 1, "T01 T02 \\ S1000 F100 R T03");
    bench_run_pulses(&bench, 1, 20);
    TEST_ASSERT_EQUAL_STRING("    20; 3", bench_ask(&bench, 7, 1));
}

void test_the_place_stays_when_the_program_idles(void)
{
    bench_do(&bench, 1, "T01 T02");
    TEST_ASSERT_EQUAL_STRING("     0; 2", bench_ask(&bench, 7, 1));
}

/* With input 1 at 1 the program jumps out of its loop each time, for ever. */
TEST_CASE("@1 L10 R I01H5 E @5 W10 J1")
TEST_CASE("@1 L10 L9 L8 R I01H5 E E E @5 W10 J1")
TEST_CASE("@1 L10 @2 L9 R I01H5 E E @5 W10 J2")
TEST_CASE("@1 '3 W10 J1 @3 L10 R I01H5 E @5 .")
TEST_CASE("L2 @1 '3 W10 J1 E @3 L10 L2 R I01H5 E E @5 .")
void test_jumping_out_of_loops_can_go_on_for_ever(const char *text)
{
    bench_set_input(&bench, 1, true);
    bench_send(&bench, 1, "[ S1000 F10");
    bench_send(&bench, 1, text);
    bench_send(&bench, 1, "]");
    bench_run_ms(&bench, 1010);
    TEST_ASSERT_EQUAL_UINT32(51, bench_count(&bench, 1, HAL_TRACE_MOVE));
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_ERROR));
}

/* Variable 80 is the memory of the program: out of the loop once, after one R. */
TEST_CASE("@1 L3 R I80H2 T80 J1 @2 E", 1 + 3)
TEST_CASE("@1 L3 L2 R I80H2 T80 J1 @2 E E", 1 + 6)
TEST_CASE("L2 @1 L3 R I80H2 T80 J1 @2 E E", 1 + 6)
TEST_CASE("@1 L7 I80H2 L2 R T80 J1 @2 R E", 1 + 7)
TEST_CASE("L3 '1 E J9 @1 L5 R I80H2 T80 . E @2 E .", 1 + 5 + 5)
void test_a_loop_reached_again_begins_anew(const char *text, unsigned passes)
{
    bench_send(&bench, 1, "[ S2000 V2000 F1");
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "@9 ]");
    TEST_ASSERT_EQUAL_UINT32(passes, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_ERROR));
}

/* A loop that the subroutine has left open is not that of the E after the call. */
TEST_CASE("'1 E J9 @1 L5 .", INTERPRETER_ERROR_LOOP_END)
TEST_CASE("L2 '1 E E J9 @1 L5 .", INTERPRETER_ERROR_LOOP_END)
TEST_CASE("L2 '1 E J9 @1 L5 .", INTERPRETER_ERROR_NONE)
TEST_CASE("L2 '1 E J9 @1 '2 L3 . @2 L5 L6 .", INTERPRETER_ERROR_NONE)
TEST_CASE("L2 L2 L2 L2 L2 '1 E E E E E J9 @1 L2 '2 . @2 L2 L2 .", INTERPRETER_ERROR_NONE)
TEST_CASE("L2 L2 L2 L2 L2 '1 E E E E E J9 @1 L2 '2 . @2 L2 L2 L2 .", INTERPRETER_ERROR_LOOP_DEPTH)
void test_a_return_closes_the_loops_begun_since_the_call(const char *text, int error)
{
    bench_send(&bench, 1, "[");
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "@9 ]");
    TEST_ASSERT_EQUAL_INT(error, bench.unit.interpreter[0].error);
}

/* A subroutine that calls itself from its loop: each call has a loop of its own. */
void test_a_loop_is_not_the_one_of_a_call_before(void)
{
    bench_do(&bench, 1, "[ S2000 V2000 F1 '1 J9 @1 L3 R I80H2 T80 '1 @2 E . @9 ]");
    TEST_ASSERT_EQUAL_UINT32(6, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_ERROR));
}

/* The E in the subroutine ends the loop of the caller; the loop begun after it is the subroutine's. */
void test_a_subroutine_may_end_the_loop_of_its_caller(void)
{
    bench_do(&bench, 1, "[ L1 '1 E J9 @1 E L3 . @9 ]");
    TEST_ASSERT_EQUAL_INT(INTERPRETER_ERROR_LOOP_END, bench.unit.interpreter[0].error);
}
