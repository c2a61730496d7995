/* Store Flash and the start after a reset of the unit (spec, sections 2, 6 and 7). */
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

static uint8_t store_program(unsigned motor)
{
    (void)bench_ask(&bench, MESSAGES_STORE_FLASH, motor);
    TEST_ASSERT_EQUAL_UINT32(3, bench.answer_length);
    return bench.answer[2];
}

void test_a_stored_program_is_loaded_and_started(void)
{
    bench_do(&bench, 2, "\\ S1000 F7 R");
    TEST_ASSERT_EQUAL_UINT8(STORE_OK, store_program(2));
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_INT64(7, bench_position(&bench, 2));
    TEST_ASSERT_EQUAL_STRING("S1000F7R", bench_ask(&bench, 5, 2));
}

void test_after_a_watchdog_or_a_fault_no_stored_program_starts(void)
{
    bench_do(&bench, 2, "\\ S1000 F7 R");
    TEST_ASSERT_EQUAL_UINT8(STORE_OK, store_program(2));
    int64_t position = bench_position(&bench, 2);
    bench_restart_badly(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_INT64(7, position);
    TEST_ASSERT_EQUAL_INT64(0, bench_position(&bench, 2));
}

void test_the_other_motors_have_no_program_then(void)
{
    bench_do(&bench, 2, "S1000 F7 R");
    store_program(2);
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_STRING("", bench_ask(&bench, 5, 1));
}

void test_stored_programs_start_on_the_same_tick(void)
{
    bench_do(&bench, 0, "S1000 F7 R");
    store_program(0);
    bench_run_ms(&bench, 100);
    bench_restart(&bench);
    uint64_t start = bench_now(&bench);
    bench_run_idle(&bench);
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_UINT64(start + TICKS_PER_MS, bench_pulse_tick(&bench, motor, 8));
    }
}

void test_only_commands_since_the_last_reset_are_stored(void)
{
    bench_do(&bench, 1, "T02 \\ T01");
    store_program(1);
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_HEX8(0x01, bench.machine.outputs);
}

void test_a_new_program_replaces_the_old_one(void)
{
    bench_do(&bench, 1, "T01");
    store_program(1);
    bench_do(&bench, 1, "\\ T02");
    store_program(1);
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_STRING("T02", bench_ask(&bench, 5, 1));
}

void test_an_empty_program_replaces_the_old_one_too(void)
{
    bench_do(&bench, 1, "T01");
    store_program(1);
    bench_do(&bench, 1, "\\");
    TEST_ASSERT_EQUAL_UINT8(STORE_OK, store_program(1));
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_STRING("", bench_ask(&bench, 5, 1));
}

void test_a_program_that_was_not_stored_is_forgotten(void)
{
    bench_do(&bench, 1, "T01");
    store_program(1);
    bench_do(&bench, 1, "T02");
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_STRING("T01", bench_ask(&bench, 5, 1));
}

void test_a_full_memory_of_the_longest_commands_can_be_stored(void)
{
    bench_do(&bench, 2, "W1");
    for (unsigned i = 0; i < 700; i++) {
        bench_send(&bench, 1, "=-2000000000");
    }
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT8(STORE_OK, store_program(1));
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_size_t(700 * 12, strlen(bench_ask(&bench, 5, 1)));
    TEST_ASSERT_EQUAL_INT64(-2000000000, bench_position(&bench, 1));
}

void test_after_a_reset_of_the_unit_everything_is_as_at_first(void)
{
    bench_do(&bench, 1, "S1000 F7 R T01 T80 T40 T41 T51");
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_INT64(0, bench_position(&bench, 1));
    TEST_ASSERT_EQUAL_HEX8(0, bench.machine.outputs);
    TEST_ASSERT_EQUAL_HEX16(0, bench.unit.shared.variables);
    TEST_ASSERT_FALSE(bench.unit.shared.memory_locked);
    TEST_ASSERT_TRUE(bench.unit.io.connected);
    TEST_ASSERT_EQUAL_UINT8(0, bench.unit.interpreter[0].order.mark_outputs);
}

void test_the_led_shows_what_the_motor_does_after_a_reset_of_the_unit(void)
{
    bench_send(&bench, 1, "S1000 G+");
    bench_run_ms(&bench, 100);
    store_program(1);
    bench_restart(&bench);
    bench_run_ms(&bench, 100);
    TEST_ASSERT_TRUE(bench.machine.led[0]);
}

void test_storing_does_not_move_a_pulse(void)
{
    bench_send(&bench, 1, "S1000 F100 R");
    bench_run_pulses(&bench, 1, 50);
    TEST_ASSERT_EQUAL_UINT8(STORE_OK, store_program(0));
    bench_run_idle(&bench);
    for (uint32_t pulse = 1; pulse <= 100; pulse++) {
        TEST_ASSERT_EQUAL_UINT64(pulse * (uint64_t)TICKS_PER_MS, bench_pulse_tick(&bench, 1, pulse));
    }
}

void test_a_damaged_program_is_not_run_and_shown(void)
{
    bench_do(&bench, 1, "S1000F7R");
    bench_do(&bench, 2, "S1000F9R");
    store_program(0);
    *bench_find_in_flash(&bench, "S1000F7R") ^= 1U;
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_INT64(INTERPRETER_ERROR_STORED_PROGRAM, bench_event(&bench, 1, HAL_TRACE_ERROR, 0)->value);
    TEST_ASSERT_EQUAL_INT64(0, bench_position(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(9, bench_position(&bench, 2));
}

void test_a_reset_makes_a_motor_with_a_damaged_program_run_again(void)
{
    bench_do(&bench, 1, "S1000F7R");
    store_program(1);
    *bench_find_in_flash(&bench, "S1000F7R") ^= 1U;
    bench_restart(&bench);
    bench_run_ms(&bench, 100);
    bench_do(&bench, 1, "\\T01");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

TEST_CASE("T01 ?")
TEST_CASE("T01 V0")
TEST_CASE("T01 {")
TEST_CASE("? T01")
void test_a_stored_text_that_is_no_program_is_not_run(const char *text)
{
    TEST_ASSERT_EQUAL_INT(STORE_OK, store_save(&bench.unit.store, 0, (const uint8_t *)text, (uint32_t)strlen(text)));
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_INT64(INTERPRETER_ERROR_STORED_PROGRAM, bench_event(&bench, 1, HAL_TRACE_ERROR, 0)->value);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_STRING("", bench_ask(&bench, 5, 1));
}

void test_a_memory_that_reports_an_error_is_told_and_the_old_program_stays(void)
{
    bench_do(&bench, 1, "T01");
    store_program(1);
    bench_do(&bench, 1, "\\T02");
    bench.machine.faults.flash_fail_at = bench.machine.flash_operations + 1;
    TEST_ASSERT_EQUAL_UINT8(STORE_WRITE_FAILED, store_program(1));
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_STRING("T01", bench_ask(&bench, 5, 1));
}

void test_storing_for_all_motors_tells_of_one_that_failed(void)
{
    bench_do(&bench, 0, "T01");
    bench.machine.faults.flash_fail_at = bench.machine.flash_operations + 1;
    TEST_ASSERT_EQUAL_UINT8(STORE_WRITE_FAILED, store_program(0));
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_STRING("T01", bench_ask(&bench, 5, 4));
}
