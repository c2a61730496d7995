/* `\` in every state of a program (spec, section 5.6). */
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

/* States: what leads there, and what is sent or seen then. None of them lets T02 be run. */
TEST_CASE("T03", "")
TEST_CASE("W1000 T02", "")
TEST_CASE("O05 T02", "")
TEST_CASE("[ T02", "")
TEST_CASE("@1 V5 J1", "")
TEST_CASE("S1000 F5000 R T02", "")
TEST_CASE("S1000 G+ T02", "")
TEST_CASE("S1000 )05 T02", "")
TEST_CASE("S100 V1000 A2000 F2000 R T02", "")
TEST_CASE("S100 V1000 A2000 F2000 R T02", "K")
TEST_CASE("S100 V1000 A2000 F2000 R T02", "\\T02")
TEST_CASE("W1000 T02", "K")
TEST_CASE("E T02", "")
TEST_CASE("X03 W1000 T02", "X")
TEST_CASE("X03 S100 V1000 A2000 F2000 R T02", "X")
TEST_CASE("M03 S100 V1000 A2000 F2000 R T02", "X")
void test_a_reset_in_every_state_runs_what_follows_and_nothing_before(const char *text, const char *then)
{
    bench_send(&bench, 1, text);
    bench_run_ms(&bench, 500);
    if (then[0] == 'X') {
        bench_set_input(&bench, 3, true);
    } else if (then[0] != '\0') {
        bench_send(&bench, 1, then);
    }
    bench_do(&bench, 1, "\\ T01");
    bench_send(&bench, 1, "]");
    bench_run_ms(&bench, 3000);
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
    TEST_ASSERT_FALSE(bench_output(&bench, 2));
}

void test_a_moving_motor_stops_down_its_ramp_before_what_follows(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_do(&bench, 1, "\\ S1000 F10 R");
    TEST_ASSERT_EQUAL_INT64(948, bench_event(&bench, 1, HAL_TRACE_DONE, 0)->value);
    TEST_ASSERT_EQUAL_INT64(958, bench_position(&bench, 1));
}

void test_what_follows_begins_at_the_last_pulse_of_the_stop(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_do(&bench, 1, "\\ S1000 F1 R");
    TEST_ASSERT_EQUAL_UINT64(TICKS_PER_MS, bench_pulse_tick(&bench, 1, 949) - bench_pulse_tick(&bench, 1, 948));
}

void test_commands_sent_while_the_reset_stops_the_motor_wait_too(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_send(&bench, 1, "\\");
    bench_run_ms(&bench, 10);
    bench_send(&bench, 1, "S1000");
    bench_send(&bench, 1, "V500");
    bench_do(&bench, 1, "F10 R");
    TEST_ASSERT_EQUAL_INT64(958, bench_position(&bench, 1));
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 500U, bench_pulse_tick(&bench, 1, 958) - bench_pulse_tick(&bench, 1, 957));
}

static void expect_new_program_stopped_by_k(void)
{
    bench_send(&bench, 1, "\\ C100 T01 S1000 F10 R");
    bench_run_ms(&bench, 5);
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_INT(INTERPRETER_STOPPED, bench_state(&bench, 1));
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(10, bench_position(&bench, 1));
}

void test_k_stops_what_follows_while_the_reset_stops_the_motor(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    expect_new_program_stopped_by_k();
}

void test_k_stops_what_follows_a_reset_while_an_earlier_k_stops_the_motor(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_send(&bench, 1, "K");
    bench_run_ms(&bench, 5);
    expect_new_program_stopped_by_k();
}

void test_k_stops_what_follows_a_reset_while_x_stops_the_motor(void)
{
    bench_send(&bench, 1, "X04 S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_set_input(&bench, 4, true);
    bench_run_ms(&bench, 5);
    bench_set_input(&bench, 4, false);
    expect_new_program_stopped_by_k();
}

void test_a_reset_in_a_wait_does_not_keep_its_clock(void)
{
    bench_send(&bench, 1, "W16000000");
    bench_run_ms(&bench, 10);
    bench_do(&bench, 1, "\\ S1000 F1 R");
    TEST_ASSERT_EQUAL_UINT64(11 * TICKS_PER_MS, bench_pulse_tick(&bench, 1, 1));
}

void test_commands_before_the_reset_in_the_same_message_are_never_run(void)
{
    bench_do(&bench, 1, "T02 S1000 F7 R \\ T01 \\ T03");
    TEST_ASSERT_EQUAL_HEX8(0x04, bench.machine.outputs);
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
}

void test_the_memory_is_cleared_and_the_reset_is_not_stored(void)
{
    bench_do(&bench, 1, "T02 T03");
    bench_do(&bench, 1, "\\ T01 W5");
    TEST_ASSERT_EQUAL_STRING("T01W5", bench_ask(&bench, 5, 1));
}

void test_the_start_values_are_loaded(void)
{
    bench_do(&bench, 1, "S700 V5 A77 B9");
    bench_do(&bench, 1, "\\");
    const struct interpreter *interpreter = &bench.unit.interpreter[0];
    TEST_ASSERT_EQUAL_UINT32(100, interpreter->order.start_speed_steps_per_s);
    TEST_ASSERT_EQUAL_UINT32(1000, interpreter->order.speed_steps_per_s);
    TEST_ASSERT_EQUAL_UINT32(2000, interpreter->order.accel_steps_per_s2);
    TEST_ASSERT_EQUAL_UINT32(0, interpreter->order.steps);
    TEST_ASSERT_FALSE(interpreter->order.backward);
}

void test_steps_are_forgotten(void)
{
    bench_do(&bench, 1, "S1000 F9");
    bench_do(&bench, 1, "\\ R");
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
}

void test_guards_are_forgotten(void)
{
    bench_do(&bench, 1, "M02 N03");
    bench_set_input(&bench, 2, true);
    bench_do(&bench, 1, "\\ S1000 F9 R");
    TEST_ASSERT_EQUAL_UINT32(9, bench_pulses(&bench, 1));
}

void test_the_compound_table_is_forgotten(void)
{
    bench_do(&bench, 1, "F9 Y");
    bench_do(&bench, 1, "\\ S1000 F2 R");
    TEST_ASSERT_EQUAL_UINT32(2, bench_pulses(&bench, 1));
}

void test_loops_and_calls_are_forgotten(void)
{
    bench_do(&bench, 1, "[ L9 L9 L9 L9 L9 L9 L9 L9 '1 @1 '2 @2 '3 @3 '4 @4 '5 @5 '6 @6 ]");
    bench_do(&bench, 1, "\\ [ L1 L1 L1 L1 L1 L1 L1 L1 '1 @1 '2 @2 '3 @3 '4 @4 '5 @5 '6 @6 ]");
    TEST_ASSERT_EQUAL_INT(INTERPRETER_IDLE, bench_state(&bench, 1));
}

void test_a_loop_end_after_a_reset_is_an_error(void)
{
    bench_do(&bench, 1, "L9");
    bench_do(&bench, 1, "\\ E");
    TEST_ASSERT_EQUAL_INT(INTERPRETER_FAILED, bench_state(&bench, 1));
}

void test_t51_is_switched_off(void)
{
    bench_do(&bench, 1, "T51");
    bench_do(&bench, 1, "\\ S1000 F2 Y R");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
}

void test_an_output_of_t51_is_not_set_after_a_reset(void)
{
    bench_send(&bench, 1, "T51 S100 A500 V1000 F800 Y F800 Y R");
    bench_run_pulses(&bench, 1, 700);
    bench_do(&bench, 1, "\\");
    TEST_ASSERT_GREATER_THAN_INT64(800, bench_position(&bench, 1));
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
}

void test_an_error_is_cleared(void)
{
    bench_do(&bench, 1, "E");
    bench_do(&bench, 1, "\\");
    TEST_ASSERT_EQUAL_UINT8(INTERPRETER_ERROR_NONE, bench.unit.interpreter[0].error);
}

void test_the_place_is_0_until_a_command_is_run(void)
{
    bench_do(&bench, 1, "T01 T02");
    bench_do(&bench, 1, "\\");
    TEST_ASSERT_EQUAL_STRING("     0; 0", bench_ask(&bench, 7, 1));
}

void test_a_c75_that_waits_for_the_motor_to_stand_is_forgotten(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_send(&bench, 1, "K");
    bench_send(&bench, 1, "C75");
    bench_do(&bench, 1, "\\ S1000 F100 R");
    bench_send(&bench, 1, "R");
    bench_run_pulses(&bench, 1, 1070);
    bench_do(&bench, 1, "K");
    TEST_ASSERT_EQUAL_INT(INTERPRETER_STOPPED, bench_state(&bench, 1));
}

void test_position_outputs_variables_and_t40_stay(void)
{
    bench_do(&bench, 1, "S1000 F7 R T01 T80 T40");
    bench_do(&bench, 1, "\\");
    TEST_ASSERT_EQUAL_INT64(7, bench_position(&bench, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_HEX16(1, bench.unit.shared.variables);
    TEST_ASSERT_TRUE(bench.unit.shared.memory_locked);
}

void test_a_reset_is_traced_once(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_send(&bench, 1, "\\");
    bench_do(&bench, 1, "\\");
    TEST_ASSERT_EQUAL_UINT32(1, bench_count(&bench, 1, HAL_TRACE_STOP));
    TEST_ASSERT_EQUAL_INT64(AXIS_CAUSE_COMMAND, bench_event(&bench, 1, HAL_TRACE_STOP, 0)->value);
}

void test_a_reset_of_an_idle_motor_stops_nothing(void)
{
    bench_do(&bench, 1, "\\ T01");
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_STOP));
}

void test_a_reset_of_one_motor_leaves_the_others_alone(void)
{
    bench_send(&bench, 0, "S1000 F100 R");
    bench_run_pulses(&bench, 1, 50);
    bench_do(&bench, 2, "\\");
    TEST_ASSERT_EQUAL_INT64(100, bench_position(&bench, 1));
    TEST_ASSERT_INT64_WITHIN(1, 50, bench_position(&bench, 2));
}

void test_a_reset_at_every_pulse_of_a_move_leaves_the_motor_ready(void)
{
    for (uint32_t pulse = 1; pulse <= 40; pulse++) {
        bench_init(&bench);
        bench_send(&bench, 1, "S100 V700 A9000 F40 R");
        bench_run_pulses(&bench, 1, pulse);
        bench_do(&bench, 1, "\\ C100 S1000 F3 R");
        TEST_ASSERT_EQUAL_INT64(3, bench_position(&bench, 1));
        bench_check(&bench);
    }
}
