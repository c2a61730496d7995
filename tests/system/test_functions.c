/* T40 to T58 as functions (spec, section 7): T41, and those that are reserved. T40 is in test_memory.c, T51 to T58 in
 * test_compound.c. */
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

void test_with_t41_outputs_are_held_at_0(void)
{
    bench_do(&bench, 1, "T01 T41 T02");
    TEST_ASSERT_EQUAL_HEX8(0x00, bench.machine.outputs);
}

void test_t41_is_of_the_unit(void)
{
    bench_do(&bench, 1, "T41");
    bench_do(&bench, 2, "S1000 F50 R");
    TEST_ASSERT_EQUAL_UINT32(0, bench.pulse_count);
}

void test_c41_connects_the_outputs_again(void)
{
    bench_do(&bench, 1, "T01 T41 T02 C01 C41");
    TEST_ASSERT_EQUAL_HEX8(0x02, bench.machine.outputs);
    bench_do(&bench, 1, "S1000 F50 R");
    TEST_ASSERT_EQUAL_UINT32(50, bench.pulse_count);
}

void test_t41_during_a_move_of_another_motor_holds_back_the_rest_of_its_pulses(void)
{
    bench_send(&bench, 1, "S1000 F50 R");
    bench_run_pulses(&bench, 1, 20);
    bench_do(&bench, 2, "T41");
    TEST_ASSERT_EQUAL_UINT32(20, bench.pulse_count);
    TEST_ASSERT_EQUAL_INT64(50, bench_position(&bench, 1));
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
    TEST_ASSERT_EQUAL_UINT8(0, bench.unit.interpreter[0].mark_outputs);
    TEST_ASSERT_EQUAL_INT(INTERPRETER_IDLE, bench_state(&bench, 1));
}
