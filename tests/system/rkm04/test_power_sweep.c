/* Power goes at every pulse of moves of every kind: after it the unit stands at 0 with its outputs off, knows nothing
 * of what was not stored, and makes the same pulses from the stored program as ever. */
#include <stdio.h>
#include <string.h>

#include "bench.h"
#include "unity.h"

enum {
    PULSES_MAX = 80,
    STOP_INPUT = 7,
    OTHER_OUTPUT = 8,
    OTHER = 2, /* a motor with a program that is not stored */
    SETTLE_MS = 1,
};

static struct bench bench;
static uint64_t due[PULSES_MAX]; /* ticks from power-on, of the move that nothing disturbs */
static unsigned cuts;

void setUp(void)
{
    bench_init(&bench);
    cuts = 0;
}

void tearDown(void)
{
    bench_check(&bench);
}

/* Power off and on. What is not stored is gone, and the other motor goes on as soon as it is told to. */
static uint64_t restart(void)
{
    bench_set_input(&bench, STOP_INPUT, false);
    uint64_t begin = bench_now(&bench);
    bench.event_count = 0;
    bench.edge_count = 0;
    bench.pulse_count = 0;
    memset(bench.made, 0, sizeof bench.made);
    bench_restart(&bench);
    TEST_ASSERT_EQUAL_INT64(0, bench_position(&bench, 1));
    bench_run_ms(&bench, SETTLE_MS);
    TEST_ASSERT_EQUAL_HEX8(0, bench.machine.outputs);
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, OTHER));
    TEST_ASSERT_EQUAL_STRING("", bench_ask(&bench, MESSAGES_GET_COMMAND, OTHER));
    bench_send(&bench, OTHER, "T08 S300 V700 A9000 F9999 R");
    bench_run_ticks(&bench, 1);
    TEST_ASSERT_TRUE(bench_output(&bench, OTHER_OUTPUT));
    return begin;
}

/* So many pulses of the stored program; an input stops it after one of them. */
static void make_pulses(uint32_t pulses, uint32_t stop_after)
{
    if (stop_after != 0 && pulses > stop_after) {
        bench_run_pulses(&bench, 1, stop_after);
        bench_set_input(&bench, STOP_INPUT, true);
    }
    bench_run_pulses(&bench, 1, pulses);
}

static void assert_pulses_are_as_ever(uint64_t begin, uint32_t pulses)
{
    for (uint32_t pulse = 1; pulse <= pulses; pulse++) {
        TEST_ASSERT_EQUAL_UINT64(due[pulse - 1U], bench_pulse_tick(&bench, 1, pulse) - begin);
    }
}

/* Kinds of moves, how many pulses they make, and after which one an input stops them. */
TEST_CASE("S100 V900 A9000 F3 R", 3, 0)
TEST_CASE("S300 V200 A9000 B25 R", 25, 0)
TEST_CASE("S100 V2000 A9000 F60 R", 60, 0)
TEST_CASE("S100 V500 A9000 B70 R", 70, 0)
TEST_CASE("S90 V900 A4000 F20 Y V16000 A1 F1 Y V250 A12000 F15 Y V1200 A9000 F24 Y R", 60, 0)
TEST_CASE("S500 V300 A8000 B20 Y V900 B30 Y V40 B2 Y R", 52, 0)
TEST_CASE("S100 V800 A9000 G-", 80, 0)
TEST_CASE("S400 )08", 80, 0)
TEST_CASE("M07 S100 V1000 A9000 F200 R", 40, 20) /* stopped on its ramp up, */
TEST_CASE("M07 S100 V500 A9000 B70 R", 54, 40)   /* in its cruise, */
TEST_CASE("M07 S100 V2000 A9000 F60 R", 60, 40)  /* and on its ramp down */
void test_power_that_goes_at_any_pulse_leaves_nothing_behind(const char *text, uint32_t pulses, uint32_t stop_after)
{
    static const uint64_t after[] = {0, TICKS_PER_MS};
    const uint8_t store[] = {MESSAGES_STORE_FLASH, '1'};
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(&bench, 1, text));
    bench_message(&bench, store, sizeof store);
    TEST_ASSERT_EQUAL_UINT8(STORE_OK, bench.answer[2]);
    uint64_t begin = restart();
    make_pulses(pulses, stop_after);
    for (uint32_t pulse = 1; pulse <= pulses; pulse++) {
        due[pulse - 1U] = bench_pulse_tick(&bench, 1, pulse) - begin;
    }
    for (uint32_t pulse = 1; pulse <= pulses; pulse++) {
        for (unsigned place = 0; place < sizeof after / sizeof after[0]; place++) {
            begin = restart();
            make_pulses(pulse, stop_after);
            bench_run_ticks(&bench, after[place]);
            assert_pulses_are_as_ever(begin, pulse);
            cuts++;
        }
    }
    begin = restart();
    make_pulses(pulses, stop_after);
    assert_pulses_are_as_ever(begin, pulses);
    printf("%u power cuts\n", cuts);
}
