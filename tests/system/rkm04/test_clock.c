/* The program clock (spec, section 5.2): everything to the tick. With S1000 a move of n steps takes n ms exactly. */
#include <stdio.h>

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

static uint64_t after_ms(uint64_t start, uint32_t milliseconds)
{
    return start + (uint64_t)milliseconds * TICKS_PER_MS;
}

void test_a_move_begins_when_the_message_comes(void)
{
    bench_run_ms(&bench, 1234);
    uint64_t start = bench_now(&bench);
    bench_do(&bench, 1, "S1000 F3 R");
    TEST_ASSERT_EQUAL_UINT64(after_ms(start, 1), bench_pulse_tick(&bench, 1, 1));
    TEST_ASSERT_EQUAL_UINT64(start, bench_event(&bench, 1, HAL_TRACE_MOVE, 0)->tick);
}

TEST_CASE("R R")
TEST_CASE("R D R")
TEST_CASE("R @1 T01 T02 C01 R")
void test_moves_in_a_row_join_without_a_gap(const char *text)
{
    uint64_t start = bench_now(&bench);
    bench_send(&bench, 1, "S1000 F3");
    bench_do(&bench, 1, text);
    for (uint32_t pulse = 1; pulse <= 6; pulse++) {
        TEST_ASSERT_EQUAL_UINT64(after_ms(start, pulse), bench_pulse_tick(&bench, 1, pulse));
    }
}

TEST_CASE(1)
TEST_CASE(200)
TEST_CASE(59000)
void test_w_adds_exactly_its_milliseconds(unsigned milliseconds)
{
    char text[40];
    (void)snprintf(text, sizeof text, "S1000 F1 R W%u R", milliseconds);
    bench_do(&bench, 1, text);
    TEST_ASSERT_EQUAL_UINT64(after_ms(bench_pulse_tick(&bench, 1, 1), milliseconds + 1),
                             bench_pulse_tick(&bench, 1, 2));
}

void test_the_longest_wait_is_kept_to_the_tick(void)
{
    bench_send(&bench, 1, "S1000 F1 R W16000000 R");
    bench_run_ms(&bench, 16000000);
    TEST_ASSERT_EQUAL_UINT32(1, bench_pulses(&bench, 1));
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT64(after_ms(0, 16000002), bench_pulse_tick(&bench, 1, 2));
}

/* Pulse k of pass j stands j * (T + W) after pulse k of the first pass; T is a ramp and no whole number of ticks. */
void test_a_loop_does_not_drift(void)
{
    enum {
        STEPS = 30,
        PASSES = 200
    };
    bench_send(&bench, 1, "S100 V800 A3000 F30 L200 R W7 E");
    bench_run_pulses(&bench, 1, STEPS * PASSES);
    uint64_t period = bench_pulse_tick(&bench, 1, STEPS + 1) - bench_pulse_tick(&bench, 1, 1);
    for (uint32_t pass = 1; pass < PASSES; pass++) {
        for (uint32_t pulse = 1; pulse <= STEPS; pulse++) {
            TEST_ASSERT_EQUAL_UINT64(bench_pulse_tick(&bench, 1, pulse) + pass * period,
                                     bench_pulse_tick(&bench, 1, pass * STEPS + pulse));
        }
    }
}

void test_four_busy_motors_do_not_drift(void)
{
    enum {
        PASSES = 50
    };
    bench_do(&bench, 0, "[ S1000 F3 @1 R W5 T80 C80 D J1");
    bench_send(&bench, 0, "]");
    bench_run_pulses(&bench, 4, 3 * PASSES);
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        uint64_t first = bench_pulse_tick(&bench, motor, 1);
        for (uint32_t pass = 1; pass < PASSES - 1; pass++) {
            TEST_ASSERT_EQUAL_UINT64(after_ms(first, 8 * pass), bench_pulse_tick(&bench, motor, 3 * pass + 1));
        }
    }
}

void test_waits_in_a_row_add_up(void)
{
    uint64_t start = bench_now(&bench);
    bench_do(&bench, 1, "S1000 F1 W3 W4 R");
    TEST_ASSERT_EQUAL_UINT64(after_ms(start, 8), bench_pulse_tick(&bench, 1, 1));
}

TEST_CASE("O03", true)
TEST_CASE("Z03", false)
void test_a_wait_for_an_input_sets_the_clock_to_when_it_was_seen(const char *text, bool level)
{
    uint64_t edge = 50 * TICKS_PER_MS + 4321;
    bench_set_input(&bench, 3, !level);
    bench_plan_input(&bench, edge, 3, level);
    bench_send(&bench, 1, "S1000 F1");
    bench_send(&bench, 1, text);
    bench_do(&bench, 1, "R");
    TEST_ASSERT_EQUAL_UINT64(after_ms(edge, 1), bench_pulse_tick(&bench, 1, 1));
}

void test_motors_released_by_one_message_start_on_the_same_tick(void)
{
    bench_do(&bench, 1, "[ S1000 F1 R");
    bench_do(&bench, 2, "S1000 [ @1 T80 C80 T81 C81 T82 C82 T83 C83 T84 C84 T85 C85 T86 C86 T87 C87 F1 R");
    bench_do(&bench, 3, "S1000 F1 [ R");
    bench_do(&bench, 4, "[ [ S1000 B1 R");
    uint64_t released = bench_now(&bench);
    bench_do(&bench, 0, "]");
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_UINT64(after_ms(released, 1), bench_pulse_tick(&bench, motor, 1));
    }
}

/* Motor 2 comes to its `[` only after the message: it starts with the others if its program has got that far. */
void test_a_motor_that_reaches_the_hold_at_the_release_starts_with_the_others(void)
{
    bench_send(&bench, 1, "S1000 [ F1 R");
    bench_send(&bench, 2, "S1000 F1 R [ R");
    bench_run_pulses(&bench, 2, 1);
    uint64_t released = bench_now(&bench);
    bench_do(&bench, 0, "]");
    TEST_ASSERT_EQUAL_UINT64(after_ms(released, 1), bench_pulse_tick(&bench, 1, 1));
    TEST_ASSERT_EQUAL_UINT64(after_ms(released, 1), bench_pulse_tick(&bench, 2, 2));
}

/* 10 passes of main, 20 us each, are within the slack of the clock: the start is exact. */
void test_a_short_calculation_does_not_shift_the_next_move(void)
{
    bench_do(&bench, 1, "S1000 F1 R L38 T80 C80 E R");
    TEST_ASSERT_EQUAL_UINT64(TICKS_PER_MS, bench_pulse_tick(&bench, 1, 2) - bench_pulse_tick(&bench, 1, 1));
}

void test_a_move_after_a_long_calculation_starts_now(void)
{
    bench_do(&bench, 1, "S1000 F1 R L255 L255 E E R");
    uint64_t start = bench_event(&bench, 1, HAL_TRACE_MOVE, 1)->tick;
    TEST_ASSERT_GREATER_THAN_UINT64(bench_pulse_tick(&bench, 1, 1) + 10 * TICKS_PER_MS, start);
    TEST_ASSERT_EQUAL_UINT64(after_ms(start, 1), bench_pulse_tick(&bench, 1, 2));
}

void test_a_wait_after_a_long_calculation_has_its_full_length(void)
{
    bench_do(&bench, 1, "S1000 F1 L255 L255 E E W5 R");
    uint64_t start = bench_event(&bench, 1, HAL_TRACE_WAIT, 0)->tick;
    TEST_ASSERT_GREATER_THAN_UINT64(10 * TICKS_PER_MS, start);
    TEST_ASSERT_EQUAL_UINT64(after_ms(start, 6), bench_pulse_tick(&bench, 1, 1));
}

void test_outputs_change_when_their_command_is_run(void)
{
    bench_do(&bench, 1, "W30 T04");
    TEST_ASSERT_EQUAL_UINT64(after_ms(0, 30), bench_event(&bench, 1, HAL_TRACE_OUT, 0)->tick);
}

void test_a_shifted_epoch_shifts_the_pulses_and_changes_nothing_else(void)
{
    static const uint64_t epochs[] = {0, UINT32_MAX - 100, UINT64_C(1) << 40, UINT32_MAX - TICK_HZ / 100};
    uint64_t ticks[4][40];
    for (unsigned i = 0; i < 4; i++) {
        bench_init_at(&bench, epochs[i]);
        bench_do(&bench, 1, "S100 V700 A4000 F20 R W3 D R");
        for (uint32_t pulse = 0; pulse < 40; pulse++) {
            ticks[i][pulse] = bench_pulse_tick(&bench, 1, pulse + 1);
        }
        bench_check(&bench);
    }
    for (unsigned i = 1; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT64_ARRAY(ticks[0], ticks[i], 40);
    }
}
