/* The unit on its line: from bytes to pulses and back to bytes, in virtual time at 19 200 Bd. */
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

#define BYTE_TICKS LINE_BENCH_BYTE_TICKS

static uint8_t message[MESSAGES_REQUEST_BYTES_MAX + 1];

void test_a_request_is_answered(void)
{
    line_check(&line);
}

void test_the_answer_begins_1_ms_after_the_request(void)
{
    uint64_t end = line_request(&line, NODE, 1, MESSAGES_VERSION, "");
    (void)line_answer(&line, 1);
    TEST_ASSERT_EQUAL_UINT64(end + TICKS_PER_MS + BYTE_TICKS, line.sent[0].tick);
}

void test_the_bytes_of_an_answer_follow_each_other_without_a_gap(void)
{
    bench_do(&bench, 1, "L200 T01 C01 T02 C02 E");
    line_request(&line, NODE, 1, MESSAGES_GET_TABLE, "1");
    line_request(&line, NODE, 1, MESSAGES_GET_POSITION, "0");
    TEST_ASSERT_NOT_NULL(line_answer(&line, 1));
    for (uint32_t i = 1; i < line.sent_count; i++) {
        TEST_ASSERT_EQUAL_UINT64(BYTE_TICKS, line.sent[i].tick - line.sent[i - 1].tick);
    }
}

void test_a_unit_has_the_node_that_its_switch_shows_at_the_start(void)
{
    for (uint8_t node = 1; node <= 16; node++) {
        host_machine_set_node(&bench.machine, node);
        bench_restart(&bench);
        for (uint8_t asked = 0; asked <= 17; asked++) {
            line_request(&line, asked, 1, MESSAGES_VERSION, "");
            const char *text = line_answer(&line, 1);
            TEST_ASSERT_EQUAL(asked == node, text != NULL);
        }
    }
}

void test_frames_with_the_bit_of_answers_are_ignored(void)
{
    line_request(&line, 0x80 | NODE, 1, MESSAGES_SET_COMMAND, "1T01");
    TEST_ASSERT_NULL(line_answer(&line, 1));
    TEST_ASSERT_FALSE(bench_output(&bench, 1));
}

void test_a_broadcast_is_executed_without_an_answer(void)
{
    line_request(&line, 0, 1, MESSAGES_SET_COMMAND, "1T01");
    TEST_ASSERT_NULL(line_answer(&line, 1));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

/* The end of the frame is the same moment for all units, whatever each of them is doing. */
TEST_CASE("")
TEST_CASE("@1 J1")
TEST_CASE("@1 T80 C80 F1 D J1")
void test_motors_start_at_the_end_of_the_frame_that_releases_them(const char *others)
{
    bench_send(&bench, 1, "S1000 [ F1 R");
    bench_send(&bench, 2, "S1000 [ B1 R");
    bench_send(&bench, 3, others);
    bench_send(&bench, 4, others);
    bench_run_ticks(&bench, 12345);
    uint64_t end = line_request(&line, 0, 0, MESSAGES_SET_COMMAND, "0]");
    bench_run_ms(&bench, 10);
    TEST_ASSERT_EQUAL_UINT64(end + TICKS_PER_MS, bench_pulse_tick(&bench, 1, 1));
    TEST_ASSERT_EQUAL_UINT64(end + TICKS_PER_MS, bench_pulse_tick(&bench, 2, 1));
}

void test_a_program_starts_at_the_end_of_its_frame(void)
{
    uint64_t end = line_request(&line, NODE, 0, MESSAGES_SET_COMMAND, "0S1000F1R");
    bench_run_ms(&bench, 10);
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_UINT64(end + TICKS_PER_MS, bench_pulse_tick(&bench, motor, 1));
    }
}

/* All bytes at once, as a fast connection gives them: main executes one request a pass. The third one comes before
 * what programs have lived through already, and counts from there. */
void test_requests_that_come_at_the_same_time_count_from_then_or_from_the_pass_before(void)
{
    uint64_t tick = bench_now(&bench) + 12345;
    uint32_t length = frame_write(line.frame, NODE, 1,
                                  "\002"
                                  "1S1000F1R",
                                  10);
    length += frame_write(line.frame + length, NODE, 2,
                          "\002"
                          "2S1000F1R",
                          10);
    length += frame_write(line.frame + length, NODE, 3,
                          "\002"
                          "3S1000F1R",
                          10);
    for (uint32_t i = 0; i < length; i++) {
        line.script[i] = (struct host_line_byte){.tick = tick, .value = line.frame[i]};
    }
    host_machine_set_line(&bench.machine, line.script, length);
    bench_run_ms(&bench, 10);
    TEST_ASSERT_EQUAL_UINT64(tick + TICKS_PER_MS, bench_pulse_tick(&bench, 1, 1));
    TEST_ASSERT_EQUAL_UINT64(tick + TICKS_PER_MS, bench_pulse_tick(&bench, 2, 1));
    TEST_ASSERT_EQUAL_UINT64(tick + HOST_PASS_TICKS + TICKS_PER_MS, bench_pulse_tick(&bench, 3, 1));
}

/* A Set Command message of so many bytes that ends in a move. */
static void run_long_request(uint32_t length)
{
    static const char begin[] = "?1S1000F3";
    memset(message, ' ', length);
    memcpy(message, begin, sizeof begin - 1);
    message[0] = MESSAGES_SET_COMMAND;
    message[length - 1] = 'R';
    line_plan_frame(&line, NODE, 1, message, length);
    line_run(&line);
}

void test_the_longest_request_is_executed(void)
{
    run_long_request(MESSAGES_REQUEST_BYTES_MAX);
    TEST_ASSERT_NOT_NULL(line_answer(&line, 1));
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(3, bench_pulses(&bench, 1));
}

void test_a_longer_one_is_not(void)
{
    run_long_request(MESSAGES_REQUEST_BYTES_MAX + 1);
    TEST_ASSERT_NULL(line_answer(&line, 1));
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
    line_check(&line);
}

static void fill_memory(void)
{
    for (unsigned i = 0; i < PROGRAM_COMMANDS_MAX; i++) {
        bench_send(&bench, 1, "=-2000000000");
    }
    bench_run_idle(&bench);
}

void test_the_longest_answer_is_sent(void)
{
    fill_memory();
    line_request(&line, NODE, 1, MESSAGES_GET_COMMAND, "1");
    const char *text = line_answer(&line, 1);
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_EQUAL_size_t(MESSAGES_ANSWER_BYTES_MAX - 1, strlen(text));
    for (uint32_t i = 1; i < line.sent_count; i++) {
        TEST_ASSERT_EQUAL_UINT64(BYTE_TICKS, line.sent[i].tick - line.sent[i - 1].tick);
    }
}

void test_store_flash_is_answered_and_kept(void)
{
    bench_do(&bench, 1, "S1000F3R");
    line_request(&line, NODE, 1, MESSAGES_STORE_FLASH, "0");
    const char *text = line_answer(&line, 1);
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_EQUAL_MEMORY("0\0", text, 2);
    bench_restart(&bench);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(6, bench_pulses(&bench, 1));
}

/* Nobody waits for the answers: they would fall into the next request. */
void test_requests_without_a_pause_are_all_executed_and_the_last_is_answered(void)
{
    for (uint8_t number = 1; number <= 20; number++) {
        line_plan_frame(&line, NODE, number,
                        "\002"
                        "1S1000F1R",
                        10);
    }
    line_run(&line);
    TEST_ASSERT_EQUAL_UINT32(0, line.sent_count);
    TEST_ASSERT_NOT_NULL(line_answer(&line, 20));
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(20, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(19, bench.unit.line.link.receiver.counts[LINK_COUNT_UNSENT]);
}

void test_an_answer_is_not_begun_while_others_talk(void)
{
    uint64_t end = line_request(&line, NODE, 1, MESSAGES_VERSION, "");
    for (int i = 0; i < 60; i++) {
        line_plan(&line, (const uint8_t *)"\x7E", 1);
    }
    line_run(&line);
    TEST_ASSERT_GREATER_THAN_UINT64(end + 20 * TICKS_PER_MS, bench_now(&bench));
    TEST_ASSERT_NULL(line_answer(&line, 1));
    line_check(&line);
}

static void run_until_all_is_sent(void)
{
    line_drain(&line);
    line.read_count = line.sent_count;
}

/* On a bus this is a collision; a connection in both directions at once can do it. */
void test_a_request_that_comes_while_an_answer_goes_out_is_executed_after_it(void)
{
    fill_memory();
    line_request(&line, NODE, 1, MESSAGES_GET_COMMAND, "1");
    bench_run_ms(&bench, 2);
    uint64_t end = line_request(&line, NODE, 2, MESSAGES_SET_COMMAND, "2S1000F1R");
    run_until_all_is_sent();
    bench_run_idle(&bench);
    TEST_ASSERT_GREATER_THAN_UINT64(end + 1000 * (uint64_t)TICKS_PER_MS, bench_pulse_tick(&bench, 2, 1));
    TEST_ASSERT_EQUAL_UINT64(bench_event(&bench, 2, HAL_TRACE_START, 0)->tick,
                             bench_event(&bench, 2, HAL_TRACE_MOVE, 0)->tick);
    line.read_count = line.sent_count - 10; /* the second frame */
    TEST_ASSERT_EQUAL_MEMORY("2\0\0", line_answer(&line, 2), 3);
}

/* More comes than the backend keeps: what is not whole is dropped. */
void test_a_unit_that_was_deaf_while_it_sent_hears_again(void)
{
    fill_memory();
    line_request(&line, NODE, 1, MESSAGES_GET_COMMAND, "1");
    bench_run_ms(&bench, 2);
    for (unsigned i = 0; i < 200; i++) {
        line_plan_frame(&line, NODE, 0, "\001", 1);
    }
    run_until_all_is_sent();
    bench_run_ms(&bench, 1000);
    run_until_all_is_sent();
    line_check(&line);
    TEST_ASSERT_EQUAL_UINT32(1, bench.unit.line.link.receiver.counts[LINK_COUNT_BROKEN]);
}
