/* T40 to T58 as functions (spec, section 7): T41, and those that are reserved. T40 is in test_memory.c, T51 to T58 in
 * test_compound.c. */
#include <stdlib.h>

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

void test_with_t41_a_program_runs_as_usual_without_a_pulse(void)
{
    bench_do(&bench, 1, "T41 S1000 F50 R W10 D R R");
    TEST_ASSERT_EQUAL_UINT32(0, bench.pulse_count);
    TEST_ASSERT_EQUAL_INT64(-50, bench_position(&bench, 1));
    TEST_ASSERT_EQUAL_UINT64(160 * TICKS_PER_MS, bench_event(&bench, 1, HAL_TRACE_DONE, 2)->tick);
}

void test_with_t41_outputs_are_held_at_0_at_once(void)
{
    bench_send(&bench, 2, "S1000 F50 R");
    bench_run_pulses(&bench, 2, 20);
    bench_send(&bench, 1, "T01 T41 T02");
    bench_run_ms(&bench, 1);
    TEST_ASSERT_EQUAL_HEX8(0x00, bench.machine.outputs);
}

void test_t41_is_of_the_unit(void)
{
    bench_do(&bench, 2, "T41");
    bench_do(&bench, 0, "S1000 F50 R");
    TEST_ASSERT_EQUAL_UINT32(0, bench.pulse_count);
}

void test_c41_connects_the_outputs_again(void)
{
    bench_do(&bench, 1, "T01 T41 T02 C01 C41");
    TEST_ASSERT_EQUAL_HEX8(0x02, bench.machine.outputs);
    bench_do(&bench, 1, "S1000 F50 R");
    TEST_ASSERT_EQUAL_UINT32(50, bench.pulse_count);
}

/* Motor 1 or 3, so that T41 comes from a motor that is polled before and after. */
TEST_CASE(1)
TEST_CASE(3)
void test_t41_lets_a_motor_that_moves_finish_its_move_and_makes_no_other(unsigned motor)
{
    bench_send(&bench, motor, "S1000 F50 R R");
    bench_run_pulses(&bench, motor, 20);
    bench_do(&bench, 2, "T41");
    TEST_ASSERT_EQUAL_UINT32(50, bench.pulse_count);
    TEST_ASSERT_EQUAL_INT64(100, bench_position(&bench, motor));
}

TEST_CASE(1)
TEST_CASE(3)
void test_c41_lets_a_simulated_move_end_and_puts_the_position_back(unsigned motor)
{
    bench_do(&bench, motor, "S1000 F7 R");
    bench_do(&bench, 2, "T41");
    bench_send(&bench, motor, "F50 R F5 R");
    bench_run_ms(&bench, 20);
    bench_send(&bench, 2, "C41");
    bench_run_ticks(&bench, 20 * TICKS_PER_MS + 1);
    TEST_ASSERT_EQUAL_UINT32(7, bench.pulse_count);
    TEST_ASSERT_EQUAL_INT64(47, bench_position(&bench, motor));
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(12, bench.pulse_count);
    TEST_ASSERT_EQUAL_INT64(12, bench_position(&bench, motor));
}

/* In compound moves and runs without end, too, and at the top rate. */
TEST_CASE("S2000 V16000 A60000 F9000 R", 9000)
TEST_CASE("S2000 V16000 A60000 F4000 Y F5000 Y R", 9000)
void test_t41_and_c41_at_any_time_of_a_move_cost_no_pulse(const char *text, unsigned steps)
{
    bench_send(&bench, 1, text);
    for (unsigned i = 0; i < 30; i++) {
        bench_send(&bench, 2, i % 2 == 0 ? "T41" : "C41");
        bench_run_ms(&bench, 20);
    }
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(steps, bench.pulse_count);
    TEST_ASSERT_EQUAL_INT64(steps, bench_position(&bench, 1));
}

TEST_CASE("M03 G+")
TEST_CASE("M03 G-")
TEST_CASE(")03")
void test_a_run_without_end_that_t41_finds_is_made_to_its_end(const char *text)
{
    bench_send(&bench, 1, "S1000");
    bench_send(&bench, 1, text);
    bench_run_pulses(&bench, 1, 20);
    bench_send(&bench, 2, "T41");
    bench_run_ms(&bench, 100);
    bench_set_input(&bench, 3, true);
    bench_do(&bench, 1, "F50 R");
    uint32_t made = bench.pulse_count;
    TEST_ASSERT_GREATER_THAN_UINT32(100, made);
    bench_do(&bench, 2, "C41");
    TEST_ASSERT_EQUAL_INT64(made, llabs(bench_position(&bench, 1)));
}

/* Where K has stopped a move the motor stands: what is left is made as the switch is by then. */
void test_a_motor_that_k_has_stopped_stands(void)
{
    bench_send(&bench, 1, "S1000 F50 R");
    bench_run_pulses(&bench, 1, 20);
    bench_do(&bench, 1, "K");
    uint32_t made = bench.pulse_count;
    bench_do(&bench, 2, "T41");
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_UINT32(made, bench.pulse_count);
    TEST_ASSERT_EQUAL_INT64(50, bench_position(&bench, 1));
    bench_do(&bench, 2, "C41");
    TEST_ASSERT_EQUAL_INT64(made, bench_position(&bench, 1));
}

void test_a_c75_that_waits_for_the_stand_goes_on_in_simulation(void)
{
    bench_send(&bench, 1, "S100 V1000 A2000 F2000 R");
    bench_run_pulses(&bench, 1, 700);
    bench_send(&bench, 1, "K");
    bench_send(&bench, 2, "T41");
    bench_do(&bench, 1, "C75");
    TEST_ASSERT_EQUAL_UINT32(948, bench.pulse_count);
    TEST_ASSERT_EQUAL_INT64(2000, bench_position(&bench, 1));
}

void test_the_position_goes_back_even_if_the_simulated_program_has_written_it(void)
{
    bench_do(&bench, 1, "S1000 F50 R T41 C100 F9 R =500 C41");
    TEST_ASSERT_EQUAL_INT64(50, bench_position(&bench, 1));
    bench_do(&bench, 1, "G55");
    TEST_ASSERT_EQUAL_UINT32(55, bench.pulse_count);
}

void test_g_and_h_go_by_the_simulated_position_until_c41(void)
{
    bench_do(&bench, 1, "S1000 F50 R T41 H H G20 C41 G20");
    TEST_ASSERT_EQUAL_INT64(-50, bench_event(&bench, 1, HAL_TRACE_MOVE, 1)->value);
    TEST_ASSERT_EQUAL_INT64(20, bench_event(&bench, 1, HAL_TRACE_MOVE, 2)->value);
    TEST_ASSERT_EQUAL_INT64(-30, bench_event(&bench, 1, HAL_TRACE_MOVE, 3)->value);
    TEST_ASSERT_EQUAL_UINT32(80, bench.pulse_count);
}

void test_the_led_shows_what_would_be_sent(void)
{
    bench_do(&bench, 1, "T41 S1000 F50 R");
    uint64_t on_ticks = bench_led_tick(&bench, 1, 2) - bench_led_tick(&bench, 1, 1);
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS, 50 * TICKS_PER_MS, on_ticks);
}

/* A motor that rests is disconnected at once, not only when it is to move: DIR is at 0, too. */
TEST_CASE(1)
TEST_CASE(3)
void test_dir_of_a_motor_that_rests_follows_at_once(unsigned motor)
{
    bench_do(&bench, motor, "S1000 B5 R");
    bench_do(&bench, 2, "T41");
    TEST_ASSERT_FALSE(bench.machine.connected[motor - 1U]);
    bench_do(&bench, 2, "C41");
    TEST_ASSERT_TRUE(bench.machine.connected[motor - 1U]);
}

void test_t41_stays_over_a_reset_of_the_motor(void)
{
    bench_do(&bench, 1, "T41");
    bench_do(&bench, 1, "\\ S1000 F5 R");
    TEST_ASSERT_EQUAL_UINT32(0, bench.pulse_count);
}

TEST_CASE("T42 T43 T44 T45 T46 T47 T48 T49 T50")
TEST_CASE("C42 C43 C44 C45 C46 C47 C48 C49 C50")
void test_reserved_functions_have_no_effect(const char *text)
{
    struct io io = bench.unit.io;
    bench_do(&bench, 1, text);
    TEST_ASSERT_EQUAL_MEMORY(&io, &bench.unit.io, sizeof io);
    TEST_ASSERT_EQUAL_UINT8(0, bench.unit.interpreter[0].order.mark_outputs);
    TEST_ASSERT_EQUAL_INT(INTERPRETER_IDLE, bench_state(&bench, 1));
}
