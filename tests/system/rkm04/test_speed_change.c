/* V alone while the motor moves (spec, section 5.4). */
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

static uint64_t interval_ticks(uint32_t pulse)
{
    return bench_pulse_tick(&bench, 1, pulse) - bench_pulse_tick(&bench, 1, pulse - 1);
}

TEST_CASE("V2000", 2000)
TEST_CASE("V300", 300)
TEST_CASE(" {faster} V01500\n", 1500)
void test_the_speed_of_the_move_in_progress_changes(const char *text, unsigned speed)
{
    bench_send(&bench, 1, "S100 V1000 A9000 F3000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_do(&bench, 1, text);
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / speed, interval_ticks(2000));
    TEST_ASSERT_EQUAL_INT64(3000, bench_position(&bench, 1));
}

void test_the_change_begins_within_a_millisecond(void)
{
    bench_send(&bench, 1, "S100 V1000 A9000 F3000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_do(&bench, 1, "V2000");
    TEST_ASSERT_LESS_THAN_UINT64(interval_ticks(700), interval_ticks(702));
}

void test_the_speed_can_change_as_often_as_wanted(void)
{
    bench_send(&bench, 1, "S100 V1000 A9000 F9000 R");
    for (uint32_t i = 1; i <= 10; i++) {
        bench_run_pulses(&bench, 1, 700 * i);
        bench_send(&bench, 1, i % 2 == 1 ? "V1500" : "V500");
        TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / (i == 1 ? 1000U : i % 2 == 1 ? 500U : 1500U), interval_ticks(700 * i));
    }
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(10, bench_count(&bench, 1, HAL_TRACE_SPEED));
    TEST_ASSERT_EQUAL_INT64(9000, bench_position(&bench, 1));
}

void test_a_change_is_not_stored(void)
{
    bench_send(&bench, 1, "S1000F3000R");
    bench_run_pulses(&bench, 1, 700);
    bench_do(&bench, 1, "V2000");
    TEST_ASSERT_EQUAL_STRING("S1000F3000R", bench_ask(&bench, 5, 1));
}

void test_the_next_move_has_the_programmed_speed(void)
{
    bench_send(&bench, 1, "S100 V500 A9000 F1000 R R");
    bench_run_pulses(&bench, 1, 500);
    bench_do(&bench, 1, "V1000");
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 1000U, interval_ticks(800));
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 500U, interval_ticks(1500));
}

void test_only_the_present_section_of_a_compound_move_changes(void)
{
    bench_send(&bench, 1, "S100 V500 A9000 F1000 Y V400 Y R");
    bench_run_pulses(&bench, 1, 500);
    bench_do(&bench, 1, "V1000");
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 1000U, interval_ticks(800));
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 400U, interval_ticks(1500));
    TEST_ASSERT_EQUAL_INT64(2000, bench_position(&bench, 1));
}

void test_the_speed_of_an_endless_run_changes(void)
{
    bench_send(&bench, 1, "S100 V500 A9000 G+");
    bench_run_pulses(&bench, 1, 500);
    bench_send(&bench, 1, "V1000");
    bench_run_pulses(&bench, 1, 1000);
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 1000U, interval_ticks(1000));
    bench_do(&bench, 1, "K");
}

TEST_CASE("V500 T01")
TEST_CASE("V500 V600")
void test_v_in_a_longer_message_is_stored(const char *text)
{
    bench_send(&bench, 1, "S1000 F100 R");
    bench_run_pulses(&bench, 1, 50);
    bench_do(&bench, 1, text);
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_SPEED));
    TEST_ASSERT_NOT_NULL(strstr(bench_ask(&bench, 5, 1), "V500"));
}

TEST_CASE("S1000")
TEST_CASE("W1000")
TEST_CASE("O03")
TEST_CASE("[")
TEST_CASE("E")
void test_v_alone_while_the_motor_stands_is_stored(const char *before)
{
    bench_send(&bench, 1, before);
    bench_run_ms(&bench, 10);
    bench_send(&bench, 1, "V500");
    TEST_ASSERT_NOT_NULL(strstr(bench_ask(&bench, 5, 1), "V500"));
}

void test_v_alone_after_the_last_pulse_is_stored(void)
{
    bench_send(&bench, 1, "S1000 F100 R");
    bench_run_ticks(&bench, 100 * TICKS_PER_MS + 1);
    bench_send(&bench, 1, "V500");
    TEST_ASSERT_NOT_NULL(strstr(bench_ask(&bench, 5, 1), "V500"));
}

void test_v_in_a_limit_run_has_no_effect(void)
{
    bench_send(&bench, 1, "S1000 )05");
    bench_run_pulses(&bench, 1, 50);
    bench_send(&bench, 1, "V500");
    bench_run_pulses(&bench, 1, 60);
    TEST_ASSERT_EQUAL_UINT64(TICKS_PER_MS, interval_ticks(60));
    TEST_ASSERT_EQUAL_STRING("S1000)05", bench_ask(&bench, 5, 1));
    bench_do(&bench, 1, "K");
}

TEST_CASE(true)
TEST_CASE(false)
void test_v_while_the_motor_is_being_stopped_has_no_effect(bool by_guard)
{
    bench_send(&bench, 1, "S100 V1000 A2000 M03 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    if (by_guard) {
        bench_set_input(&bench, 3, true);
    } else {
        bench_send(&bench, 1, "K");
    }
    bench_run_ms(&bench, 100);
    bench_send(&bench, 1, "V5000");
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(948, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_STRING("S100V1000A2000M03F2000R", bench_ask(&bench, 5, 1));
}

void test_v_for_all_motors_changes_those_that_move_and_is_stored_by_the_others(void)
{
    bench_send(&bench, 1, "S1000 F300 R");
    bench_run_pulses(&bench, 1, 50);
    bench_do(&bench, 0, "V500");
    TEST_ASSERT_EQUAL_STRING("S1000F300R", bench_ask(&bench, 5, 1));
    TEST_ASSERT_EQUAL_STRING("V500", bench_ask(&bench, 5, 2));
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 500U, interval_ticks(200));
}
