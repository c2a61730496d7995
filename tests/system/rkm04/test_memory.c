/* The 700 commands of program memory (spec, section 6) and T40 (section 7). */
#include <stdio.h>
#include <string.h>

#include "bench.h"
#include "unity.h"

static struct bench bench;
static char program[BENCH_TEXT_BYTES_MAX + 1];

void setUp(void)
{
    bench_init(&bench);
}

void tearDown(void)
{
    bench_check(&bench);
}

/* `head`, then as many commands V5 as make it `commands` with those of the head. */
static char *fill(const char *head, unsigned head_commands, unsigned commands)
{
    (void)strcpy(program, head);
    for (unsigned i = head_commands; i < commands; i++) {
        (void)strcat(program, "V5");
    }
    return program;
}

void test_700_commands_fit(void)
{
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(&bench, 1, fill("T01", 1, 700)));
    TEST_ASSERT_EQUAL_size_t(3 + 2 * 699, strlen(bench_ask(&bench, 5, 1)));
}

void test_the_701st_command_overwrites_the_oldest_with_a_warning(void)
{
    TEST_ASSERT_EQUAL_UINT8(3, bench_send(&bench, 1, fill("T01A7", 2, 701)));
    TEST_ASSERT_EQUAL_UINT8(0, bench.answer[3]);
    TEST_ASSERT_EQUAL_size_t(2 * 700, strlen(bench_ask(&bench, 5, 1)));
    TEST_ASSERT_EQUAL_STRING_LEN("A7V5", bench_ask(&bench, 5, 1), 4);
}

void test_every_further_message_warns(void)
{
    bench_do(&bench, 1, fill("", 0, 700));
    TEST_ASSERT_EQUAL_UINT8(3, bench_send(&bench, 1, "T01"));
    TEST_ASSERT_EQUAL_UINT8(3, bench_send(&bench, 1, "T02"));
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_HEX8(0x03, bench.machine.outputs);
}

void test_a_reset_makes_room(void)
{
    bench_do(&bench, 1, fill("", 0, 700));
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(&bench, 1, fill("\\", 0, 700)));
}

void test_what_overflowed_before_a_reset_in_the_same_message_is_no_warning(void)
{
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(&bench, 1, strcat(fill("", 0, 710), "\\T01")));
}

void test_one_motor_that_overflows_makes_the_warning_for_all(void)
{
    bench_do(&bench, 3, fill("", 0, 700));
    TEST_ASSERT_EQUAL_UINT8(3, bench_send(&bench, 0, "T01"));
}

/* What motor 1 has done to outputs, in order: levels at the end may be the same whatever was run. */
static void assert_switched(const char *expected)
{
    char text[64] = "";
    uint32_t count = bench_count(&bench, 1, HAL_TRACE_OUT);
    for (uint32_t i = 0, length = 0; i < count && length + 4U < sizeof text; i++) {
        int value = (int)bench_event(&bench, 1, HAL_TRACE_OUT, i)->value;
        length += (uint32_t)snprintf(text + length, sizeof text - length, "%+d ", value);
    }
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

/* W100, T01 and T02 are overwritten while the program waits: it goes on with the oldest that is left. */
void test_execution_goes_on_with_the_oldest_command_left(void)
{
    bench_send(&bench, 1, fill("W100 T01 T02 T03", 4, 700));
    bench_run_ms(&bench, 10);
    TEST_ASSERT_EQUAL_UINT8(3, bench_send(&bench, 1, "T04 T05 T06"));
    bench_run_idle(&bench);
    assert_switched("+3 +4 +5 +6 ");
    TEST_ASSERT_EQUAL_UINT64(100 * TICKS_PER_MS, bench_event(&bench, 1, HAL_TRACE_OUT, 0)->tick);
}

void test_a_label_that_was_overwritten_is_not_stored(void)
{
    bench_send(&bench, 1, fill("@1 W100", 2, 700));
    bench_run_ms(&bench, 10);
    bench_send(&bench, 1, "J1");
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_INT64(INTERPRETER_ERROR_NO_LABEL, bench_event(&bench, 1, HAL_TRACE_ERROR, 0)->value);
}

void test_a_loop_whose_beginning_was_overwritten_goes_on_with_the_oldest(void)
{
    bench_send(&bench, 1, fill("L2 W10 T01 W100", 4, 699));
    bench_run_ms(&bench, 50);
    bench_send(&bench, 1, "E C01 T02");
    bench_run_idle(&bench);
    assert_switched("+1 +1 -1 +2 ");
    TEST_ASSERT_EQUAL_UINT32(3, bench_count(&bench, 1, HAL_TRACE_WAIT));
}

void test_a_program_longer_than_the_memory_runs_in_parts(void)
{
    bench_send(&bench, 1, "S2000 V2000 F1");
    for (unsigned part = 0; part < 4; part++) {
        (void)strcpy(program, "");
        for (unsigned i = 0; i < 250; i++) {
            (void)strcat(program, "R");
        }
        bench_send(&bench, 1, program);
        bench_run_idle(&bench);
    }
    TEST_ASSERT_EQUAL_INT64(1000, bench_position(&bench, 1));
    TEST_ASSERT_EQUAL_STRING("     0;1003", bench_ask(&bench, 7, 1));
}

void test_with_t40_the_commands_that_do_not_fit_are_ignored(void)
{
    bench_do(&bench, 1, fill("T40 A7", 2, 699));
    TEST_ASSERT_EQUAL_UINT8(3, bench_send(&bench, 1, "T01 T02"));
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_HEX8(0x01, bench.machine.outputs);
    TEST_ASSERT_EQUAL_STRING_LEN("T40A7V5", bench_ask(&bench, 5, 1), 7);
}

void test_t40_is_of_the_unit(void)
{
    bench_do(&bench, 2, "T40");
    bench_do(&bench, 1, fill("A7", 1, 700));
    TEST_ASSERT_EQUAL_UINT8(3, bench_send(&bench, 1, "T01"));
    TEST_ASSERT_EQUAL_STRING_LEN("A7V5", bench_ask(&bench, 5, 1), 4);
}

void test_c40_lets_commands_be_overwritten_again(void)
{
    bench_do(&bench, 2, "T40");
    bench_do(&bench, 1, fill("A7", 1, 700));
    bench_do(&bench, 2, "C40");
    bench_send(&bench, 1, "T01");
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_HEX8(0x01, bench.machine.outputs);
}

void test_k_c75_and_a_change_of_speed_need_no_room(void)
{
    bench_do(&bench, 2, "T40");
    bench_send(&bench, 1, fill("S1000 F3000 R", 3, 700));
    bench_run_pulses(&bench, 1, 100);
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(&bench, 1, "V500"));
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(&bench, 1, "K"));
    bench_run_ms(&bench, 100);
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(&bench, 1, "C75"));
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_INT64(3000, bench_position(&bench, 1));
}
