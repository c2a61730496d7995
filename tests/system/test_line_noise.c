/* A bad line: pauses, noise, floods. Nothing wrong is executed, and pulses keep their times. */
#include <string.h>

#include "line_bench.h"
#include "unity.h"

enum { NODE = LINE_BENCH_NODE };

static struct bench bench;
static struct line_bench line;

void setUp(void)
{
    bench_init(&bench);
    line_init(&line, &bench);
}

void tearDown(void)
{
    bench_check(&bench);
}

#define GAP_TICKS (50 * (uint64_t)TICKS_PER_MS)

/* A request, each byte `apart` from the one before, and the one at `late` (0: none) longer. */
static void run_slow_request(uint64_t apart, uint32_t late, uint64_t late_ticks)
{
    uint32_t length = frame_write(line.frame, NODE, 1, "\002" "1T01", 5);
    uint64_t tick = bench_now(&bench);
    for (uint32_t i = 0; i < length; i++) {
        tick += late != 0 && i == late ? late_ticks : apart;
        line.script[i] = (struct host_line_byte){.tick = tick, .value = line.frame[i]};
    }
    line.script_length = length;
    line.asked = PROTOCOL_SET_COMMAND;
    host_machine_set_line(&bench.machine, line.script, length);
    line_run(&line);
}

void test_a_request_with_50_ms_between_its_bytes_is_executed(void)
{
    run_slow_request(GAP_TICKS, 0, 0);
    TEST_ASSERT_NOT_NULL(line_answer(&line, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_a_longer_pause_at_any_place_drops_the_request(void)
{
    for (uint32_t late = 1; late < frame_write(line.frame, NODE, 1, "\002" "1T01", 5); late++) {
        run_slow_request(LINE_BENCH_BYTE_TICKS, late, GAP_TICKS + 1);
        TEST_ASSERT_NULL(line_answer(&line, 1));
        TEST_ASSERT_FALSE(bench_output(&bench, 1));
    }
    line_check(&line);
}

static void plan_noise(uint32_t length)
{
    for (uint32_t i = 0; i < length; i++) {
        uint8_t byte = line_random_byte();
        line_plan(&line, &byte, 1);
    }
}

void test_a_million_bytes_of_noise_do_nothing_and_the_next_request_is_answered(void)
{
    enum { NOISE_BYTES = 1000000, CHUNK_BYTES = 10000 };
    for (unsigned i = 0; i < NOISE_BYTES / CHUNK_BYTES; i++) {
        plan_noise(CHUNK_BYTES);
        line_run(&line);
    }
    bench_run_ms(&bench, 100);
    TEST_ASSERT_EQUAL_UINT32(0, bench.unit.link.receiver.counts[LINK_COUNT_FRAMES]);
    TEST_ASSERT_EQUAL_UINT32(0, bench.event_count);
    TEST_ASSERT_EQUAL_UINT32(0, line.sent_count);
    line_check(&line);
}

/* Requests, broadcasts, requests for others, noise; nothing that changes what the motors do. */
static void plan_flood(uint32_t bytes)
{
    while (line.script_length < bytes) {
        line_plan_frame(&line, NODE, 1, "\001", 1);
        line_plan_frame(&line, 0, 0, "\004" "0", 2);
        line_plan_frame(&line, NODE + 1, 5, "\002" "0F100R", 7);
        line_plan_frame(&line, NODE, 2, "\006" "1", 2);
        plan_noise(40);
        line_plan_frame(&line, NODE, 0, "\005" "2", 2);
    }
}

static void send_programs(void)
{
    bench_send(&bench, 1, "S100 V16000 A60000 F12000 R W50 B12000 R");
    bench_send(&bench, 2, "S2000 V15999 A60000 F12000 R B12000 R");
    bench_send(&bench, 3, "S1 V9000 A20000 F3000 Y V2000 F500 Y V12000 F5000 Y R");
    bench_send(&bench, 4, "L100 S700 V900 A3000 F7 R W3 D R E");
}

void test_a_flood_at_full_load_of_the_line_moves_no_pulse(void)
{
    enum { FLOOD_BYTES = 8000 };
    static struct bench_pulse quiet[BENCH_PULSES_MAX];
    send_programs();
    bench_run_idle(&bench);
    uint32_t count = bench.pulse_count;
    uint64_t time = bench_now(&bench);
    memcpy(quiet, bench.pulses, sizeof quiet);

    setUp();
    plan_flood(FLOOD_BYTES);
    send_programs();
    bench_run_ticks(&bench, time);

    TEST_ASSERT_GREATER_THAN_UINT32(100, bench.unit.link.receiver.counts[LINK_COUNT_FRAMES]);
    TEST_ASSERT_EQUAL_UINT32(count, bench.pulse_count);
    for (uint32_t i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_UINT64(quiet[i].tick, bench.pulses[i].tick);
        TEST_ASSERT_EQUAL_UINT8(quiet[i].motor, bench.pulses[i].motor);
    }
}
