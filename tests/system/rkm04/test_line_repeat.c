/* Requests that come again: at most one execution, the same answer (firmware/rkm04/docs/line.md, "Repeats"). */
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

static void assert_done(const char *text)
{
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_EQUAL_MEMORY("1\0\0", text, 3);
}

static void assert_done_storing(const char *text)
{
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_EQUAL_MEMORY("1\0", text, 2);
}

void test_a_repeated_request_is_not_executed_and_answered_again(void)
{
    for (unsigned i = 0; i < 4; i++) {
        line_request(&line, NODE, 7, MESSAGES_SET_COMMAND, "1S1000F3R");
        assert_done(line_answer(&line, 7));
    }
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(3, bench_pulses(&bench, 1));
}

void test_the_stored_answer_is_sent_and_not_a_new_one(void)
{
    line_request(&line, NODE, 7, MESSAGES_GET_POSITION, "1");
    TEST_ASSERT_EQUAL_STRING("1\x0a         0", line_answer(&line, 7));
    bench_do(&bench, 1, "=5");
    line_request(&line, NODE, 7, MESSAGES_GET_POSITION, "1");
    TEST_ASSERT_EQUAL_STRING("1\x0a         0", line_answer(&line, 7));
    line_request(&line, NODE, 8, MESSAGES_GET_POSITION, "1");
    TEST_ASSERT_EQUAL_STRING("1\x0a         5", line_answer(&line, 8));
}

void test_without_a_number_every_request_is_executed(void)
{
    for (unsigned i = 0; i < 3; i++) {
        line_request(&line, NODE, 0, MESSAGES_SET_COMMAND, "1S1000F3R");
        assert_done(line_answer(&line, 0));
        bench_run_idle(&bench);
    }
    TEST_ASSERT_EQUAL_UINT32(9, bench_pulses(&bench, 1));
}

static void assert_refused(uint8_t number)
{
    uint8_t refusal[FRAME_BYTES_MAX(1)];
    uint32_t length = frame_write(refusal, 0xC0 | NODE, number, "\1", 1);
    bench_run_ms(&bench, 20);
    TEST_ASSERT_EQUAL_UINT32(length, line.sent_count - line.read_count);
    for (uint32_t i = 0; i < length; i++) {
        TEST_ASSERT_EQUAL_HEX8(refusal[i], line.sent[line.read_count + i].value);
    }
    line.read_count = line.sent_count;
}

void test_after_a_reset_of_the_unit_a_repeat_is_refused(void)
{
    line_request(&line, NODE, 7, MESSAGES_SET_COMMAND, "1S1000F3R");
    assert_done(line_answer(&line, 7));
    bench_run_idle(&bench);
    bench_restart(&bench);
    for (unsigned i = 0; i < 3; i++) {
        line_request(&line, NODE, 7, MESSAGES_SET_COMMAND, "1S1000F3R");
        assert_refused(7);
    }
    TEST_ASSERT_EQUAL_UINT32(3, bench_pulses(&bench, 1));
}

/* The watchdog does not ask a master either. */
void test_after_a_reset_by_the_watchdog_too(void)
{
    line_request(&line, NODE, 7, MESSAGES_STORE_FLASH, "1");
    assert_done_storing(line_answer(&line, 7));
    bench_restart_badly(&bench);
    line_request(&line, NODE, 7, MESSAGES_STORE_FLASH, "1");
    assert_refused(7);
}

void test_requests_of_a_new_session_are_executed_after_a_reset(void)
{
    bench_restart(&bench);
    line_open(&line);
    line_request(&line, NODE, 7, MESSAGES_SET_COMMAND, "1S1000F3R");
    assert_done(line_answer(&line, 7));
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_UINT32(3, bench_pulses(&bench, 1));
}

/* A damaged repeat and two broadcasts, one of which uses the buffer of the answers, come in between. */
void test_a_repeat_is_known_after_damaged_frames_and_broadcasts(void)
{
    uint32_t length = frame_write(line.frame, NODE, 7,
                                  "\002"
                                  "1S1000F3R",
                                  10);
    line_request(&line, NODE, 7, MESSAGES_SET_COMMAND, "1S1000F3R");
    assert_done(line_answer(&line, 7));
    (void)frame_write(line.frame, NODE, 7,
                      "\002"
                      "1S1000F3R",
                      10);
    line.frame[5] ^= 4U;
    line_plan(&line, line.frame, length);
    line_request(&line, 0, 0, MESSAGES_SET_COMMAND, "2T02?");
    line_request(&line, 0, 0, MESSAGES_STORE_FLASH, "1");
    TEST_ASSERT_NULL(line_answer(&line, 0));
    line_request(&line, NODE, 7, MESSAGES_SET_COMMAND, "1S1000F3R");
    assert_done(line_answer(&line, 7));
    TEST_ASSERT_EQUAL_UINT32(3, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(1, bench.unit.line.link.receiver.counts[LINK_COUNT_FCS]);
}

/* Get Position of all motors. */
void test_the_longest_kept_answer_outlives_a_broadcast(void)
{
    char first[100];
    bench_do(&bench, 0, "=-2000000000");
    line_request(&line, NODE, 7, MESSAGES_GET_POSITION, "0");
    (void)snprintf(first, sizeof first, "%s", line_answer(&line, 7));
    line_request(&line, 0, 0, MESSAGES_SET_COMMAND, "0=0");
    line_request(&line, 0, 0, MESSAGES_STORE_FLASH, "0");
    line_request(&line, NODE, 7, MESSAGES_GET_POSITION, "0");
    TEST_ASSERT_EQUAL_STRING(first, line_answer(&line, 7));
}

/* Its request changes nothing, so it may be executed again. */
void test_a_longer_answer_does_not(void)
{
    char longer[100];
    memset(longer, 'R', sizeof longer - 1);
    longer[0] = '\\';
    longer[sizeof longer - 1] = '\0';
    bench_send(&bench, 1, longer);
    line_request(&line, NODE, 7, MESSAGES_GET_COMMAND, "1");
    TEST_ASSERT_EQUAL_size_t(sizeof longer - 1, strlen(line_answer(&line, 7)));
    bench_send(&bench, 1, "R");
    line_request(&line, NODE, 7, MESSAGES_GET_COMMAND, "1");
    TEST_ASSERT_EQUAL_size_t(sizeof longer - 1, strlen(line_answer(&line, 7)));
    line_request(&line, 0, 0, MESSAGES_VERSION, "");
    line_request(&line, NODE, 7, MESSAGES_GET_COMMAND, "1");
    TEST_ASSERT_EQUAL_size_t(sizeof longer, strlen(line_answer(&line, 7)));
}
