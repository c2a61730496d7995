/* Programs that arrive in parts, `[` and `]`, bad texts, fairness (spec, sections 2, 3, 5.1 and 5.8). */
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

void test_commands_are_run_as_soon_as_they_are_stored(void)
{
    bench_do(&bench, 1, "S1000 F5 R");
    bench_run_ms(&bench, 100);
    TEST_ASSERT_EQUAL_INT64(5, bench_position(&bench, 1));
    bench_do(&bench, 1, "R");
    TEST_ASSERT_EQUAL_INT64(10, bench_position(&bench, 1));
}

void test_parts_are_appended(void)
{
    bench_send(&bench, 1, "S1000 F5");
    bench_send(&bench, 1, "{a part of its own}");
    bench_send(&bench, 1, "");
    bench_do(&bench, 1, "R T01");
    TEST_ASSERT_EQUAL_STRING("S1000F5RT01", bench_ask(&bench, 5, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_what_comes_during_a_move_follows_it_without_a_gap(void)
{
    bench_send(&bench, 1, "S1000 F5 R");
    bench_run_pulses(&bench, 1, 3);
    bench_do(&bench, 1, "R");
    TEST_ASSERT_EQUAL_UINT64(10 * TICKS_PER_MS, bench_pulse_tick(&bench, 1, 10));
}

void test_a_program_begins_at_its_start_and_ends_when_nothing_is_left(void)
{
    bench_run_ms(&bench, 20);
    bench_do(&bench, 1, "S1000 F5 R");
    TEST_ASSERT_EQUAL_UINT64(20 * TICKS_PER_MS, bench_event(&bench, 1, HAL_TRACE_START, 0)->tick);
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS, 25 * TICKS_PER_MS, bench_event(&bench, 1, HAL_TRACE_END, 0)->tick);
}

TEST_CASE("[ T01")
TEST_CASE("] [ T01")
TEST_CASE("[ [ T01")
TEST_CASE("[ ] [ T01")
void test_a_hold_lasts_until_a_release_after_it(const char *text)
{
    bench_do(&bench, 1, text);
    bench_run_ms(&bench, 100);
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_do(&bench, 1, "T80");
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
    bench_do(&bench, 1, "]");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
    TEST_ASSERT_EQUAL_HEX16(1, bench.unit.shared.variables);
}

void test_what_is_before_a_hold_is_run(void)
{
    bench_do(&bench, 1, "T02 [ T01");
    TEST_ASSERT_EQUAL_HEX8(0x02, bench.machine.outputs);
}

void test_a_release_in_the_same_message_holds_nothing(void)
{
    bench_do(&bench, 1, "S1000 [ F5 R ]");
    TEST_ASSERT_EQUAL_UINT64(TICKS_PER_MS, bench_pulse_tick(&bench, 1, 1));
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_WAIT));
}

void test_a_hold_in_a_loop_is_released_once_for_all_passes(void)
{
    bench_do(&bench, 1, "L3 [ F1 S1000 R E");
    bench_do(&bench, 1, "]");
    TEST_ASSERT_EQUAL_INT64(3, bench_position(&bench, 1));
}

/* Flag and character as section 2 has them; nothing is stored on any motor and nothing moves. */
TEST_CASE("S1000 F5 R V0", 1, 'V')
TEST_CASE("S1000 F5 R V16001 ?", 1, 'V')
TEST_CASE("S1000 F5 R ?", 2, '?')
TEST_CASE("S1000 F5 R a2000", 2, 'a')
TEST_CASE("S1000 F5 R {", 2, '{')
TEST_CASE("S1000 F5 R F111111111111111111111111111111", 1, 'F')
TEST_CASE("\\ S1000 ?", 2, '?')
TEST_CASE("K ?", 2, '?')
void test_a_bad_text_changes_nothing(const char *text, uint8_t flag, uint8_t character)
{
    bench_send(&bench, 0, "T01");
    TEST_ASSERT_EQUAL_UINT8(flag, bench_send(&bench, 0, text));
    TEST_ASSERT_EQUAL_UINT8(character, bench.answer[3]);
    bench_run_idle(&bench);
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_STRING("T01", bench_ask(&bench, 5, motor));
        TEST_ASSERT_EQUAL_INT(INTERPRETER_IDLE, bench_state(&bench, motor));
    }
}

/* The pulses of motor 2 with three busy motors beside it are those that it makes alone. */
TEST_CASE("@1 J1")
TEST_CASE("@1 T80 C80 J1")
TEST_CASE("@1 I01L1")
TEST_CASE("@1 '2 J1 @2 .")
TEST_CASE("L255 L255 L255 L255 L255 L255 L255 L255 E E E E E E E E")
void test_a_loop_without_a_wait_does_not_move_the_pulses_of_another_motor(const char *text)
{
    enum {
        PULSES = 400
    };
    static uint64_t alone[PULSES];
    for (unsigned busy = 0; busy < 2; busy++) {
        bench_init(&bench);
        bench.forgets_events = true;
        bench_send(&bench, busy == 1 ? 0 : 4, text);
        bench_run_ms(&bench, 5);
        bench_send(&bench, 2, "\\ S100 V3000 A9000 F100 R W3 R D R R");
        bench_run_ms(&bench, 2000);
        for (uint32_t pulse = 0; pulse < PULSES; pulse++) {
            uint64_t tick = bench_pulse_tick(&bench, 2, pulse + 1);
            alone[pulse] = busy == 0 ? tick : alone[pulse];
            TEST_ASSERT_EQUAL_UINT64(alone[pulse], tick);
        }
        bench_check(&bench);
    }
}

void test_messages_are_answered_while_programs_loop(void)
{
    bench_send(&bench, 0, "@1 J1");
    bench_run_ms(&bench, 50);
    TEST_ASSERT_EQUAL_STRING("@1J1", bench_ask(&bench, 5, 1));
    bench_do(&bench, 0, "\\T01");
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_a_reset_in_the_middle_of_a_stream_begins_a_new_program(void)
{
    bench_send(&bench, 1, "@1 F1 S1000 R J1");
    bench_run_pulses(&bench, 1, 30);
    bench_do(&bench, 1, "\\ [ C100 S1000 F7 R");
    bench_do(&bench, 0, "]");
    TEST_ASSERT_EQUAL_INT64(7, bench_position(&bench, 1));
}
