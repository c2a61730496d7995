/* Inputs of which the unit hears late, as it does on a board: stops act at the first pulse after the change all the
 * same, and the judge sees the ramps from there on. */
#include "bench.h"
#include "unity.h"

static struct bench bench;
static struct bench still; /* the same move, with nobody who stops it */

/* What a board may need, and all that is left of 16 000 steps/s for planning. */
enum {
    LATE_TICKS = 5 * TICKS_PER_US,
    LATER_TICKS = 20 * TICKS_PER_US
};

void setUp(void)
{
    bench_init(&bench);
    bench_init(&still);
}

void tearDown(void)
{
    bench_check(&bench);
    bench_check(&still);
}

/* Runs a move of motor 1 whose guard changes at a tick. */
static void run_guarded(const char *text, uint64_t edge, uint32_t late_ticks)
{
    bench_init(&bench);
    bench.machine.faults.late_tick_ticks = late_ticks;
    bench_plan_input(&bench, edge, 3, true);
    bench_do(&bench, 1, text);
    bench_check(&bench);
}

/* Right before each pulse, so that it comes before the unit hears of the change. */
static void assert_no_later(const char *text, uint32_t late_ticks)
{
    static uint64_t expected[4000];
    host_machine_select(&still.machine);
    bench_do(&still, 1, text);
    uint32_t all = bench_pulses(&still, 1);
    for (uint32_t pulse = 1; pulse <= all; pulse++) {
        uint64_t edge = bench_pulse_tick(&still, 1, pulse) - 1U - pulse % late_ticks;
        run_guarded(text, edge, 0);
        uint32_t made = bench_pulses(&bench, 1);
        TEST_ASSERT_LESS_THAN_UINT32(sizeof expected / sizeof *expected, made);
        for (uint32_t i = 1; i <= made; i++) {
            expected[i] = bench_pulse_tick(&bench, 1, i);
        }

        run_guarded(text, edge, late_ticks);

        TEST_ASSERT_EQUAL_UINT32(made, bench_pulses(&bench, 1));
        for (uint32_t i = 1; i <= made; i++) {
            TEST_ASSERT_UINT64_WITHIN(1, expected[i], bench_pulse_tick(&bench, 1, i));
        }
        TEST_ASSERT_EQUAL_UINT64(0, bench.machine.late_steps);
    }
}

TEST_CASE("M03 S2000 V16000 A60000 F300 R")
TEST_CASE("X03 S500 V2000 A60000 B150 R")
TEST_CASE("M03 S300 A9000 V900 F40 Y V3000 F60 Y V700 F30 Y R")
TEST_CASE("M03 S1500 V1500 A2000 F60 R")
void test_a_guard_that_is_seen_late_stops_at_the_same_pulse(const char *text)
{
    assert_no_later(text, LATE_TICKS);
    assert_no_later(text, LATER_TICKS);
}
