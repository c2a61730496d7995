/*
 * A stream of requests, cut in two and in three at every byte by pauses as long as the line allows: the unit executes
 * the same, once each, whatever the pieces are in which bytes come.
 *
 * RKM04_LONG=1 tries every pair of places, else those near each other.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "line_bench.h"
#include "unity.h"

enum {
    NODE = LINE_BENCH_NODE,
    STREAM_BYTES_MAX = 200,
    NEAR_BYTES = 3,
    NO_PLACE = STREAM_BYTES_MAX
};

#define PAUSE_TICKS (50 * (uint64_t)TICKS_PER_MS)

static struct bench bench;
static struct line_bench line;
static uint8_t stream[STREAM_BYTES_MAX];
static uint32_t stream_length;
static unsigned splits;

static void add_request(uint8_t number, const char *request)
{
    stream_length += frame_write(stream + stream_length, NODE, number, request, (uint32_t)strlen(request));
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(STREAM_BYTES_MAX, stream_length);
}

void setUp(void)
{
    splits = 0;
    stream_length = 0;
    add_request(1, "\0021S2000 F3 R T01");
    add_request(0x7E, "\0022=7 ~");
    add_request(0x7D, "\0021B1 R T02");
    add_request(2, "\0023L2 T03 C03 E");
    add_request(3, "\0041");
}

void tearDown(void)
{
    bench_check(&bench);
}

/* What the stream must have done; the second request is refused as a whole. */
static void assert_executed_once(void)
{
    TEST_ASSERT_EQUAL_STRING("1\012         2", line_answer(&line, 3));
    TEST_ASSERT_EQUAL_HEX8(0x03, bench.machine.outputs);
    TEST_ASSERT_EQUAL_STRING("S2000F3RT01B1RT02", bench_ask(&bench, MESSAGES_GET_COMMAND, 1));
    TEST_ASSERT_EQUAL_STRING("", bench_ask(&bench, MESSAGES_GET_COMMAND, 2));
    TEST_ASSERT_EQUAL_STRING("L2T03C03E", bench_ask(&bench, MESSAGES_GET_COMMAND, 3));
    TEST_ASSERT_EQUAL_UINT32(1 + 5, bench.unit.line.link.receiver.counts[LINK_COUNT_FRAMES]);
}

static void run_split(uint32_t first, uint32_t second)
{
    bench_init(&bench);
    line_init(&line, &bench);
    line_open(&line);
    uint64_t tick = 0;
    for (uint32_t i = 0; i < stream_length; i++) {
        tick += i == first || i == second ? PAUSE_TICKS : LINE_BENCH_BYTE_TICKS;
        line.script[i] = (struct host_line_byte){.tick = tick, .value = stream[i]};
    }
    line.script_length = stream_length;
    line.asked = MESSAGES_GET_POSITION;
    host_machine_set_line(&bench.machine, line.script, stream_length);
    line_run(&line);
    /* Answers to requests before the last one may have gone out in a pause. */
    while (line.sent_count > line.read_count && line.sent[line.sent_count - 1].tick < tick) {
        line.read_count = line.sent_count;
    }
    assert_executed_once();
    bench_check(&bench);
    splits++;
}

void test_a_stream_split_at_any_byte_is_executed_the_same(void)
{
    for (uint32_t place = 0; place < stream_length; place++) {
        run_split(place, NO_PLACE);
    }
    printf("splits of a stream of %u bytes in two: %u\n", (unsigned)stream_length, splits);
}

void test_a_stream_split_at_any_two_bytes_is_executed_the_same(void)
{
    bool all = getenv("RKM04_LONG") != NULL;
    for (uint32_t first = 0; first < stream_length; first++) {
        for (uint32_t second = first + 1; second < stream_length && (all || second <= first + NEAR_BYTES); second++) {
            run_split(first, second);
        }
    }
    printf("splits of a stream of %u bytes in three: %u\n", (unsigned)stream_length, splits);
}

/* The text of a program, too: as two messages, parted between any two commands. */
void test_a_program_in_two_messages_is_the_same_program(void)
{
    static const char *const commands[] = {"S100", "V500", "A9000", "@1", "F20", "R",  "L3",  "D", "R", "E",
                                           "'7",   "W5",   "J8",    "@7", "M03", "B5", "R",   "U", ".", "@8",
                                           "F5",   "Y",    "V900",  "Y",  "T81", "R",  "C81", "H", "[", "]"};
    enum {
        COMMANDS = sizeof commands / sizeof commands[0],
        PULSES = 100
    };
    static struct bench_pulse whole[BENCH_PULSES_MAX];
    uint32_t count = 0;
    for (uint32_t parted = 0; parted <= COMMANDS; parted++) {
        char text[2][BENCH_TEXT_BYTES_MAX] = {"", ""};
        for (uint32_t i = 0; i < COMMANDS; i++) {
            strcat(text[i >= parted ? 1 : 0], commands[i]);
        }
        bench_init(&bench);
        bench_send(&bench, 1, text[0]);
        bench_do(&bench, 1, text[1]);
        if (parted == 0) {
            count = bench.pulse_count;
            memcpy(whole, bench.pulses, sizeof whole);
        }
        TEST_ASSERT_EQUAL_UINT32(PULSES, count);
        TEST_ASSERT_EQUAL_UINT32(count, bench.pulse_count);
        for (uint32_t i = 0; i < count; i++) {
            TEST_ASSERT_EQUAL_UINT64(whole[i].tick, bench.pulses[i].tick);
            TEST_ASSERT_EQUAL(whole[i].backward, bench.pulses[i].backward);
        }
        bench_check(&bench);
    }
}
