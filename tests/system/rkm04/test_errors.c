/* Run-time errors and the LED (spec, sections 1 and 5.7). */
#include "bench.h"
#include "hal_time.h"
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

TEST_CASE("J1", INTERPRETER_ERROR_NO_LABEL)
TEST_CASE("I01L1", INTERPRETER_ERROR_NO_LABEL)
TEST_CASE("I80L1", INTERPRETER_ERROR_NO_LABEL)
TEST_CASE("'1", INTERPRETER_ERROR_NO_LABEL)
TEST_CASE("@2 @80 J1", INTERPRETER_ERROR_NO_LABEL)
TEST_CASE("E", INTERPRETER_ERROR_LOOP_END)
TEST_CASE("L1 E E", INTERPRETER_ERROR_LOOP_END)
TEST_CASE("L1 L1 L1 L1 L1 L1 L1 L1 L1", INTERPRETER_ERROR_LOOP_DEPTH)
TEST_CASE("[ '1 @1 '2 @2 '3 @3 '4 @4 '5 @5 '6 @6 '7 @7 ]", INTERPRETER_ERROR_CALL_DEPTH)
TEST_CASE("[ @1 '1 ]", INTERPRETER_ERROR_CALL_DEPTH)
TEST_CASE(".", INTERPRETER_ERROR_RETURN)
TEST_CASE("[ '1 J9 @1 . @9 . ]", INTERPRETER_ERROR_RETURN)
void test_an_error_ends_the_program(const char *text, int64_t error)
{
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "T01 F1 R");
    TEST_ASSERT_EQUAL_INT64(error, bench_event(&bench, 1, HAL_TRACE_ERROR, 0)->value);
    TEST_ASSERT_EQUAL_INT(INTERPRETER_FAILED, bench_state(&bench, 1));
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
}

TEST_CASE("I01H1")
TEST_CASE("I80H1")
void test_a_jump_that_is_not_taken_needs_no_label(const char *text)
{
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "T01");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_a_label_that_comes_later_in_the_message_is_stored_already(void)
{
    bench_do(&bench, 1, "J1 T02 @1 T01");
    TEST_ASSERT_EQUAL_HEX8(0x01, bench.machine.outputs);
}

void test_after_an_error_commands_are_stored_and_wait(void)
{
    bench_do(&bench, 1, "E");
    bench_do(&bench, 1, "] T01");
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_STRING("E]T01", bench_ask(&bench, 5, 1));
}

void test_the_place_of_an_error_can_be_asked_for(void)
{
    bench_do(&bench, 1, "T01 T02 E T03");
    TEST_ASSERT_EQUAL_STRING("     0; 3", bench_ask(&bench, 7, 1));
}

void test_an_error_of_one_motor_does_not_disturb_the_others(void)
{
    bench_send(&bench, 0, "S1000 F9 R W5 D R");
    bench_send(&bench, 2, "\\E");
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(18, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 2));
    TEST_ASSERT_EQUAL_UINT32(18, bench_pulses(&bench, 3));
}

void test_a_reset_makes_the_motor_run_again(void)
{
    bench_do(&bench, 1, "E");
    bench_do(&bench, 1, "\\ T01");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

/* An error that comes from outside while the motor moves stops it down its ramp. */
void test_a_moving_motor_stops_down_its_ramp(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R T01");
    bench_run_pulses(&bench, 1, 700);
    interpreter_fail(&bench.unit.interpreter[0], INTERPRETER_ERROR_STORED_PROGRAM, hal_time_now());
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(948, bench_pulses(&bench, 1));
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(AXIS_CAUSE_FAULT, bench_event(&bench, 1, HAL_TRACE_STOP, 0)->value);
}

void test_the_led_is_on_while_the_motor_moves(void)
{
    bench_run_ms(&bench, 100);
    bench_do(&bench, 3, "S1000 F50 R R W100");
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS, 100 * TICKS_PER_MS, bench_led_tick(&bench, 3, 1));
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS, 200 * TICKS_PER_MS, bench_led_tick(&bench, 3, 2));
    TEST_ASSERT_EQUAL_UINT32(2, bench.edge_count);
}

void test_the_led_blinks_after_an_error(void)
{
    bench_send(&bench, 2, "W100 E");
    bench_run_ms(&bench, 3000);
    for (uint32_t edge = 1; edge <= 6; edge++) {
        TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS / 10, (100 + 500 * (edge - 1)) * TICKS_PER_MS,
                                  bench_led_tick(&bench, 2, edge));
    }
    TEST_ASSERT_EQUAL_UINT32(6, bench.edge_count);
}

void test_the_led_stops_blinking_with_the_reset(void)
{
    bench_send(&bench, 2, "E");
    bench_run_ms(&bench, 2100);
    bench_do(&bench, 2, "\\");
    bench_run_ms(&bench, 2000);
    TEST_ASSERT_FALSE(bench.machine.led[1]);
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS, 2100 * TICKS_PER_MS, bench_led_tick(&bench, 2, bench.edge_count));
}

void test_the_led_is_on_while_a_failed_motor_brakes_and_blinks_then(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    interpreter_fail(&bench.unit.interpreter[0], INTERPRETER_ERROR_STORED_PROGRAM, hal_time_now());
    bench_run_ms(&bench, 2000);
    uint64_t stand = bench_event(&bench, 1, HAL_TRACE_DONE, 0)->tick;
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS, stand + 500 * TICKS_PER_MS, bench_led_tick(&bench, 1, 2));
}

void test_without_the_crystal_a_move_is_an_error_and_makes_no_pulse(void)
{
    bench.machine.faults.no_crystal = true;
    bench_do(&bench, 1, "T02 F10 R C02");
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(INTERPRETER_ERROR_NO_CRYSTAL, bench_event(&bench, 1, HAL_TRACE_ERROR, 0)->value);
    TEST_ASSERT_EQUAL_HEX8(0x02, bench.machine.outputs);
}

void test_without_the_crystal_what_k_has_left_of_a_move_is_not_gone_on_with(void)
{
    bench_send(&bench, 1, "S1000 V1000 F100 R");
    bench_run_pulses(&bench, 1, 40);
    bench_do(&bench, 1, "K");
    uint32_t made = bench_pulses(&bench, 1);
    bench.machine.faults.no_crystal = true;

    bench_do(&bench, 1, "C75");

    TEST_ASSERT_EQUAL_UINT32(made, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(INTERPRETER_ERROR_NO_CRYSTAL, bench_event(&bench, 1, HAL_TRACE_ERROR, 0)->value);
}
