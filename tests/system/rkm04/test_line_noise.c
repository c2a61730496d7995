/* A bad line: pauses, noise, damage, floods. Nothing wrong is executed, and pulses keep their times. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "line_bench.h"
#include "unity.h"

enum {
    NODE = LINE_BENCH_NODE
};

static struct bench bench;
static struct line_bench line;

void setUp(void)
{
    bench_init(&bench);
    line_init(&line, &bench);
    line_open(&line);
}

void tearDown(void)
{
    bench_check(&bench);
}

#define GAP_TICKS (50 * (uint64_t)TICKS_PER_MS)

/* A request, each byte `apart` from the one before, and the one at `late` (0: none) longer. */
static void run_slow_request(uint64_t apart, uint32_t late, uint64_t late_ticks)
{
    uint32_t length = frame_write(line.frame, NODE, 1,
                                  "\002"
                                  "1T01",
                                  5);
    uint64_t tick = bench_now(&bench);
    for (uint32_t i = 0; i < length; i++) {
        tick += late != 0 && i == late ? late_ticks : apart;
        line.script[i] = (struct host_line_byte){.tick = tick, .value = line.frame[i]};
    }
    line.script_length = length;
    line.asked = MESSAGES_SET_COMMAND;
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
    for (uint32_t late = 1; late < frame_write(line.frame, NODE, 1,
                                               "\002"
                                               "1T01",
                                               5);
         late++) {
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

static void print_counts(const char *what)
{
    printf("%s:", what);
    for (unsigned count = 0; count < LINK_COUNTS_TOTAL; count++) {
        const char *text = link_count_text((enum link_count)count);
        printf(" %" PRIu32 " %s;", bench.unit.line.link.receiver.counts[count], text);
    }
    printf(" %u events, %" PRIu32 " bytes sent\n", (unsigned)bench.event_count, line.sent_count);
}

void test_a_million_bytes_of_noise_do_nothing_and_the_next_request_is_answered(void)
{
    enum {
        NOISE_BYTES = 1000000,
        CHUNK_BYTES = 10000
    };
    for (unsigned i = 0; i < NOISE_BYTES / CHUNK_BYTES; i++) {
        plan_noise(CHUNK_BYTES);
        line_run(&line);
    }
    bench_run_ms(&bench, 100);
    print_counts("1000000 bytes of noise");
    TEST_ASSERT_EQUAL_UINT32(1, bench.unit.line.link.receiver.counts[LINK_COUNT_FRAMES]);
    TEST_ASSERT_EQUAL_UINT32(0, bench.event_count);
    TEST_ASSERT_EQUAL_UINT32(0, line.sent_count);
    line_check(&line);
}

static uint32_t random_below(uint32_t limit)
{
    uint32_t high = line_random_byte();
    return (high << 8U | line_random_byte()) % limit;
}

static void flip_bits(uint8_t *frame, uint32_t length)
{
    uint32_t count = 1U + random_below(3);
    for (uint32_t i = 0; i < count; i++) {
        frame[1U + random_below(length - 1U)] ^= (uint8_t)(1U << random_below(8));
    }
}

static void replace_bytes(uint8_t *frame, uint32_t length)
{
    uint32_t first = 1U + random_below(length - 2U);
    uint32_t last = first + random_below(3);
    for (uint32_t i = first; i <= last && i < length - 1U; i++) {
        frame[i] = line_random_byte();
    }
}

static uint32_t drop_byte(uint8_t *frame, uint32_t length)
{
    uint32_t place = 1U + random_below(length - 2U);
    memmove(frame + place, frame + place + 1U, length - place - 1U);
    return length - 1U;
}

static uint32_t insert_byte(uint8_t *frame, uint32_t length)
{
    uint32_t place = 1U + random_below(length - 2U);
    memmove(frame + place + 1U, frame + place, length - place);
    frame[place] = line_random_byte();
    return length + 1U;
}

static void swap_neighbours(uint8_t *frame, uint32_t length)
{
    uint32_t place = 1U + random_below(length - 3U);
    uint8_t first = frame[place];
    frame[place] = frame[place + 1U];
    frame[place + 1U] = first;
}

/* Damages a frame after its opening flag; returns its new length. */
static uint32_t damage(uint8_t *frame, uint32_t length)
{
    switch (random_below(5)) {
    case 0:
        return drop_byte(frame, length);
    case 1:
        return insert_byte(frame, length);
    case 2:
        replace_bytes(frame, length);
        return length;
    case 3:
        swap_neighbours(frame, length);
        return length;
    default:
        flip_bits(frame, length);
        return length;
    }
}

/* Whether a flag before or after the content is all that was added: such a frame is good. */
static bool is_still_good(const uint8_t *damaged, uint32_t damaged_length, const uint8_t *frame, uint32_t length)
{
    while (damaged_length > length && damaged[1] == LINK_FLAG) {
        damaged++;
        damaged_length--;
    }
    while (damaged_length > length && damaged[damaged_length - 2U] == LINK_FLAG) {
        damaged_length--;
    }
    return damaged_length == length && memcmp(damaged, frame, length) == 0;
}

/* A request to this unit or to all that would set an output, damaged somewhere. */
static void plan_damaged(void)
{
    static const char *const texts[] = {"\002"
                                        "0T01",
                                        "\002"
                                        "1T02W5",
                                        "\002"
                                        "4F100R",
                                        "\002"
                                        "2[T03F5R]"};
    enum {
        FRAME_MAX = 64
    };
    uint8_t good[FRAME_MAX];
    uint8_t bad[FRAME_MAX];
    const char *text = texts[random_below(sizeof texts / sizeof texts[0])];
    uint8_t address = random_below(2) == 0 ? NODE : 0;
    uint32_t length = frame_write(good, address, line_random_byte(), text, (uint32_t)strlen(text));
    uint32_t bad_length;
    do {
        memcpy(bad, good, length);
        bad_length = damage(bad, length);
    } while (is_still_good(bad, bad_length, good, length));
    line_plan(&line, bad, bad_length);
}

static uint32_t dropped_count(void)
{
    uint32_t sum = 0;
    for (unsigned count = LINK_COUNT_STRAY; count <= LINK_COUNT_GAP; count++) {
        sum += bench.unit.line.link.receiver.counts[count];
    }
    return sum;
}

void test_ten_thousand_damaged_frames_do_nothing_and_the_next_request_is_answered(void)
{
    enum {
        FRAMES = 10000,
        CHUNK_FRAMES = 100
    };
    for (unsigned i = 0; i < FRAMES / CHUNK_FRAMES; i++) {
        for (unsigned k = 0; k < CHUNK_FRAMES; k++) {
            plan_damaged();
        }
        line_run(&line);
        TEST_ASSERT_EQUAL_UINT32(line.read_count, line.sent_count);
        bench_run_ms(&bench, 100);
        line_check(&line);
        TEST_ASSERT_EQUAL_UINT32(i + 2U, bench.unit.line.link.receiver.counts[LINK_COUNT_FRAMES]);
    }
    print_counts("10000 damaged frames, 100 good ones among them");
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(FRAMES, dropped_count());
    TEST_ASSERT_EQUAL_UINT32(0, bench.unit.line.link.receiver.counts[LINK_COUNT_FOREIGN]);
    TEST_ASSERT_EQUAL_UINT32(0, bench.event_count);
}

/* Requests, broadcasts, requests for others, noise; nothing that changes what the motors do. */
static void plan_flood(uint32_t bytes)
{
    while (line.script_length < bytes) {
        line_plan_frame(&line, NODE, 1, "\001", 1);
        line_plan_frame(&line, 0, 0,
                        "\004"
                        "0",
                        2);
        line_plan_frame(&line, NODE + 1, 5,
                        "\002"
                        "0F100R",
                        7);
        line_plan_frame(&line, NODE, 2,
                        "\006"
                        "1",
                        2);
        plan_noise(40);
        line_plan_frame(&line, NODE, 0,
                        "\005"
                        "2",
                        2);
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
    enum {
        FLOOD_BYTES = 8000
    };
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

    TEST_ASSERT_GREATER_THAN_UINT32(100, bench.unit.line.link.receiver.counts[LINK_COUNT_FRAMES]);
    TEST_ASSERT_EQUAL_UINT32(count, bench.pulse_count);
    for (uint32_t i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_UINT64(quiet[i].tick, bench.pulses[i].tick);
        TEST_ASSERT_EQUAL_UINT8(quiet[i].motor, bench.pulses[i].motor);
    }
}
