#include "unity.h"

#include <string.h>

#include "frames.h"
#include "link.h"

enum {
    NODE = 5,
    OTHER = 6
};

#define BYTE_TICKS ((uint64_t)43750)

static struct link link;
static struct link_request request;
static uint8_t answer[LINK_ANSWER_BYTES_MAX];
static uint8_t frame[FRAME_BYTES_MAX(LINK_ANSWER_BYTES_MAX)];
static uint8_t content[FRAME_BYTES_MAX(LINK_ANSWER_BYTES_MAX)];
static uint8_t longest[LINK_REQUEST_BYTES_MAX];
static uint64_t tick;

static unsigned take(const uint8_t *bytes, uint32_t length)
{
    unsigned requests = 0;
    for (uint32_t i = 0; i < length; i++) {
        struct hal_line_byte byte = {.tick = tick += BYTE_TICKS, .value = bytes[i]};
        requests += link_take(&link, &byte, &request) ? 1U : 0U;
    }
    return requests;
}

/* Whether the request is to be executed; if so it is answered with the text. */
static bool ask(uint8_t number, const char *text, const char *reply)
{
    if (take(frame, frame_write(frame, NODE, number, text, (uint32_t)strlen(text))) == 0) {
        return false;
    }
    memcpy(answer, reply, strlen(reply));
    link_answer(&link, (uint32_t)strlen(reply));
    return true;
}

/* Lets the link send what it wants to within the time of an answer; returns the text after this address and the
 * number, "" for none. */
static const char *hear_from(uint8_t address, uint8_t number)
{
    uint32_t length = 0;
    uint64_t begin = link_poll(&link, tick);
    if (begin == TICK_NEVER) {
        return "";
    }
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, link_poll(&link, begin));
    while (link_is_sending(&link)) {
        frame[length++] = link_byte(&link);
        link_advance(&link);
    }
    length = frame_read(content, frame, length);
    TEST_ASSERT_GREATER_THAN_UINT32(2, length);
    TEST_ASSERT_EQUAL_HEX8(address, content[0]);
    TEST_ASSERT_EQUAL_UINT8(number, content[1]);
    content[length] = '\0';
    return (const char *)content + 2;
}

static const char *hear(uint8_t number)
{
    return hear_from(0x80 | NODE, number);
}

static void switch_on(uint8_t node)
{
    memset(answer, 0, sizeof answer);
    memset(&link, 0xEE, sizeof link);
    link_init(&link, node, answer);
}

static void open_session(uint8_t node)
{
    take(frame, frame_write(frame, node, 200, "\1", 1));
    link_answer(&link, 1);
    link_forget(&link);
}

void setUp(void)
{
    tick = 1000000;
    switch_on(NODE);
    open_session(NODE);
}

void tearDown(void)
{
}

void test_it_is_silent_at_first(void)
{
    TEST_ASSERT_FALSE(link_is_sending(&link));
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, link_poll(&link, tick));
}

void test_a_request_comes_out_whole(void)
{
    TEST_ASSERT_EQUAL_UINT(1, take(frame, frame_write(frame, NODE, 9, "hello", 5)));
    TEST_ASSERT_EQUAL_UINT32(5, request.length);
    TEST_ASSERT_EQUAL_MEMORY("hello", request.message, 5);
    TEST_ASSERT_EQUAL_UINT64(tick, request.end_tick);
    TEST_ASSERT_FALSE(request.broadcast);
}

void test_an_answer_carries_the_number_of_the_request(void)
{
    TEST_ASSERT_TRUE(ask(0, "a", "A"));
    TEST_ASSERT_EQUAL_STRING("A", hear(0));
    TEST_ASSERT_TRUE(ask(255, "b", "B"));
    TEST_ASSERT_EQUAL_STRING("B", hear(255));
}

void test_an_answer_is_due_1_ms_after_the_request(void)
{
    ask(1, "a", "A");
    TEST_ASSERT_EQUAL_UINT64(tick + TICKS_PER_MS, link_poll(&link, tick));
    TEST_ASSERT_EQUAL_UINT64(tick + TICKS_PER_MS, link_poll(&link, tick + TICKS_PER_MS - 1));
    TEST_ASSERT_FALSE(link_is_sending(&link));
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, link_poll(&link, tick + TICKS_PER_MS));
    TEST_ASSERT_TRUE(link_is_sending(&link));
}

void test_an_answer_waits_until_the_line_has_been_silent_for_1_ms(void)
{
    ask(1, "a", "A");
    (void)link_poll(&link, tick);
    take((const uint8_t *)"\x7E\x7E", 2);
    TEST_ASSERT_EQUAL_UINT64(tick + TICKS_PER_MS, link_poll(&link, tick));
}

void test_it_begins_20_ms_after_it_was_ready_at_the_latest(void)
{
    ask(1, "a", "A");
    (void)link_poll(&link, tick);
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, link_poll(&link, tick + 20 * TICKS_PER_MS));
    TEST_ASSERT_TRUE(link_is_sending(&link));
    TEST_ASSERT_EQUAL_UINT32(0, link.receiver.counts[LINK_COUNT_UNSENT]);
}

void test_later_than_that_it_is_given_up(void)
{
    ask(1, "a", "A");
    (void)link_poll(&link, tick);
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, link_poll(&link, tick + 20 * TICKS_PER_MS + 1));
    TEST_ASSERT_FALSE(link_is_sending(&link));
    TEST_ASSERT_EQUAL_UINT32(1, link.receiver.counts[LINK_COUNT_UNSENT]);
}

void test_each_answer_has_its_own_time(void)
{
    ask(1, "a", "A");
    TEST_ASSERT_EQUAL_STRING("A", hear(1));
    tick += 1000 * (uint64_t)TICKS_PER_MS;
    ask(2, "b", "B");
    TEST_ASSERT_EQUAL_STRING("B", hear(2));
}

void test_the_limits_are_those_of_the_line(void)
{
    TEST_ASSERT_EQUAL(16, LINK_NODE_MAX);
    TEST_ASSERT_EQUAL(8402, LINK_ANSWER_BYTES_MAX);
#ifdef RKM04_TINY_LIMITS
    TEST_ASSERT_EQUAL(40, LINK_REQUEST_BYTES_MAX);
#else
    TEST_ASSERT_EQUAL(8192, LINK_REQUEST_BYTES_MAX);
#endif
}

void test_every_node_answers_with_its_own_address(void)
{
    for (unsigned node = 1; node <= LINK_NODE_MAX; node++) {
        switch_on((uint8_t)node);
        open_session((uint8_t)node);
        take(frame, frame_write(frame, (uint8_t)node, 1, "a", 1));
        link_answer(&link, 1);
        (void)link_poll(&link, tick + TICKS_PER_MS);
        link_advance(&link);
        TEST_ASSERT_EQUAL_HEX8(0x80U + node, link_byte(&link));
    }
}

void test_a_request_that_took_long_is_answered_when_it_is_done(void)
{
    ask(1, "a", "A");
    uint64_t done = tick + 2000 * (uint64_t)TICKS_PER_MS;
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, link_poll(&link, done));
    TEST_ASSERT_TRUE(link_is_sending(&link));
}

void test_an_answer_that_was_given_up_is_there_for_a_repeat(void)
{
    ask(1, "a", "A");
    (void)link_poll(&link, tick);
    (void)link_poll(&link, tick + 21 * TICKS_PER_MS);
    TEST_ASSERT_FALSE(ask(1, "a", "B"));
    TEST_ASSERT_EQUAL_STRING("A", hear(1));
}

void test_a_repeat_is_answered_again_and_not_executed(void)
{
    ask(7, "a", "A");
    for (unsigned i = 1; i <= 3; i++) {
        TEST_ASSERT_EQUAL_STRING("A", hear(7));
        TEST_ASSERT_FALSE(ask(7, "a", "B"));
        TEST_ASSERT_EQUAL_UINT32(i, link.receiver.counts[LINK_COUNT_REPEATS]);
    }
}

TEST_CASE(8, "a")
TEST_CASE(7, "b")
TEST_CASE(7, "aa")
TEST_CASE(0, "a")
void test_another_number_or_message_is_no_repeat(unsigned number, const char *text)
{
    ask(7, "a", "A");
    TEST_ASSERT_TRUE(ask((uint8_t)number, text, "B"));
    TEST_ASSERT_EQUAL_STRING("B", hear((uint8_t)number));
}

void test_the_begin_of_the_last_message_is_no_repeat(void)
{
    ask(7, "aa", "A");
    TEST_ASSERT_TRUE(ask(7, "a", "B"));
}

void test_number_0_is_never_a_repeat(void)
{
    ask(0, "a", "A");
    TEST_ASSERT_TRUE(ask(0, "a", "B"));
}

void test_only_the_last_request_is_known_again(void)
{
    ask(7, "a", "A");
    ask(8, "b", "B");
    TEST_ASSERT_FALSE(ask(8, "b", "C"));
    TEST_ASSERT_TRUE(ask(7, "a", "C"));
}

void test_nothing_is_known_again_after_the_start(void)
{
    for (unsigned number = 0; number <= 255; number++) {
        setUp();
        TEST_ASSERT_TRUE(ask((uint8_t)number, "a", "A"));
    }
}

static void assert_refused(uint8_t number)
{
    TEST_ASSERT_FALSE(ask(number, "a", "A"));
    TEST_ASSERT_EQUAL_STRING("\1", hear_from(0xC0 | NODE, number));
}

void test_before_a_session_every_request_with_a_number_is_refused(void)
{
    switch_on(NODE);
    for (unsigned number = 1; number <= 255; number++) {
        assert_refused((uint8_t)number);
        assert_refused((uint8_t)number);
    }
    TEST_ASSERT_EQUAL_UINT32(0, link.receiver.counts[LINK_COUNT_REPEATS]);
}

void test_every_node_refuses_with_its_own_address(void)
{
    for (unsigned node = 1; node <= LINK_NODE_MAX; node++) {
        switch_on((uint8_t)node);
        take(frame, frame_write(frame, (uint8_t)node, 1, "a", 1));
        TEST_ASSERT_EQUAL_STRING("\1", hear_from((uint8_t)(0xC0U + node), 1));
    }
}

void test_before_a_session_requests_without_a_number_are_executed(void)
{
    switch_on(NODE);
    TEST_ASSERT_TRUE(ask(0, "a", "A"));
    TEST_ASSERT_EQUAL_STRING("A", hear(0));
    assert_refused(7);
    TEST_ASSERT_TRUE(ask(0, "a", "B"));
    TEST_ASSERT_EQUAL_STRING("B", hear(0));
}

void test_before_a_session_broadcasts_are_executed(void)
{
    switch_on(NODE);
    TEST_ASSERT_EQUAL_UINT(1, take(frame, frame_write(frame, 0, 4, "a", 1)));
    TEST_ASSERT_TRUE(request.broadcast);
    TEST_ASSERT_EQUAL_STRING("", hear(4));
}

void test_version_opens_a_session(void)
{
    switch_on(NODE);
    TEST_ASSERT_TRUE(ask(7, "\1", "V"));
    TEST_ASSERT_EQUAL_STRING("V", hear(7));
    TEST_ASSERT_TRUE(ask(8, "a", "A"));
    TEST_ASSERT_EQUAL_STRING("A", hear(8));
}

void test_a_refused_request_is_executed_when_a_session_has_been_opened(void)
{
    switch_on(NODE);
    assert_refused(7);
    TEST_ASSERT_TRUE(ask(7, "\1", "V"));
    TEST_ASSERT_TRUE(ask(7, "a", "A"));
    TEST_ASSERT_EQUAL_STRING("A", hear(7));
}

TEST_CASE(5, 0)
TEST_CASE(0, 0)
TEST_CASE(0, 7)
TEST_CASE(6, 7)
void test_version_without_a_number_or_for_others_opens_none(unsigned address, unsigned number)
{
    switch_on(NODE);
    (void)take(frame, frame_write(frame, (uint8_t)address, (uint8_t)number, "\1", 1));
    assert_refused(8);
}

/* 'ab' begins as 'aa', and comes between it and its repeat: damaged, cut, for others, too long. */
void test_a_repeat_is_known_whatever_came_in_between(void)
{
    ask(7, "aa", "A");
    uint32_t length = frame_write(frame, NODE, 7, "ab", 2);
    frame[length - 2] ^= 1U;
    TEST_ASSERT_EQUAL_UINT(0, take(frame, length));
    TEST_ASSERT_EQUAL_UINT(0, take(frame, length - 3));
    TEST_ASSERT_EQUAL_UINT(0, take(frame, frame_write(frame, OTHER, 7, "ab", 2)));
    TEST_ASSERT_EQUAL_UINT(0, take(frame, frame_write(frame, 0x80 | NODE, 7, "ab", 2)));
    for (int i = 0; i < 3 * LINK_BUFFER_BYTES; i++) {
        TEST_ASSERT_EQUAL_UINT(0, take((const uint8_t *)"b", 1));
    }
    TEST_ASSERT_FALSE(ask(7, "aa", "B"));
    TEST_ASSERT_EQUAL_STRING("A", hear(7));
}

/* Two messages that have the same length and the same FCS. */
void test_a_message_is_the_same_only_if_every_byte_is(void)
{
    uint8_t one[] = "2Taaaaaaaaaa";
    uint8_t two[sizeof one];
    uint8_t frames[2][FRAME_BYTES_MAX(sizeof one)];
    memcpy(two, one, sizeof one);
    /* The generator polynomial itself, 1 1000 1000 0001 0000 1 as its bits are sent: no FCS sees it. */
    two[4] ^= 0x11U;
    two[5] ^= 0x08U;
    two[6] ^= 0x01U;
    uint32_t length = frame_write(frames[0], NODE, 7, one, sizeof one);
    (void)frame_write(frames[1], NODE, 7, two, sizeof two);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(frames[0] + length - 3, frames[1] + length - 3, 3);
    TEST_ASSERT_EQUAL_UINT(1, take(frames[0], length));
    link_answer(&link, 1);
    TEST_ASSERT_EQUAL_UINT(1, take(frames[1], length));
}

void test_the_longest_request_is_known_again(void)
{
    memset(longest, 'x', sizeof longest);
    TEST_ASSERT_EQUAL_UINT(1, take(frame, frame_write(frame, NODE, 3, longest, sizeof longest)));
    link_answer(&link, 1);
    TEST_ASSERT_EQUAL_UINT(0, take(frame, frame_write(frame, NODE, 3, longest, sizeof longest)));
    longest[sizeof longest - 1] = 'y';
    TEST_ASSERT_EQUAL_UINT(1, take(frame, frame_write(frame, NODE, 3, longest, sizeof longest)));
}

void test_a_broadcast_is_executed_and_not_answered(void)
{
    TEST_ASSERT_EQUAL_UINT(1, take(frame, frame_write(frame, 0, 4, "a", 1)));
    TEST_ASSERT_TRUE(request.broadcast);
    TEST_ASSERT_EQUAL_STRING("", hear(4));
}

void test_a_broadcast_is_never_a_repeat(void)
{
    ask(4, "a", "A");
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_UINT(1, take(frame, frame_write(frame, 0, 4, "a", 1)));
    }
}

void test_a_broadcast_leaves_the_last_answer(void)
{
    ask(4, "a", "A");
    take(frame, frame_write(frame, 0, 5, "b", 1));
    TEST_ASSERT_EQUAL_UINT32(1, link_kept_bytes(&link));
    TEST_ASSERT_FALSE(ask(4, "a", "B"));
    TEST_ASSERT_EQUAL_STRING("A", hear(4));
}

void test_an_answer_that_is_forgotten_is_not_sent_and_not_known_again(void)
{
    ask(4, "a", "A");
    link_forget(&link);
    TEST_ASSERT_EQUAL_UINT32(0, link_kept_bytes(&link));
    TEST_ASSERT_EQUAL_STRING("", hear(4));
    TEST_ASSERT_TRUE(ask(4, "a", "B"));
}

void test_nothing_is_kept_for_a_request_without_a_number(void)
{
    ask(0, "a", "A");
    TEST_ASSERT_EQUAL_UINT32(0, link_kept_bytes(&link));
}

void test_a_request_takes_the_place_of_an_answer_that_has_not_begun(void)
{
    ask(4, "a", "A");
    ask(5, "b", "B");
    TEST_ASSERT_EQUAL_STRING("B", hear(5));
    TEST_ASSERT_EQUAL_STRING("", hear(4));
    TEST_ASSERT_EQUAL_UINT32(1, link.receiver.counts[LINK_COUNT_UNSENT]);
}

void test_a_broadcast_too(void)
{
    ask(4, "a", "A");
    take(frame, frame_write(frame, 0, 5, "b", 1));
    TEST_ASSERT_EQUAL_STRING("", hear(4));
    TEST_ASSERT_EQUAL_UINT32(1, link.receiver.counts[LINK_COUNT_UNSENT]);
}

void test_frames_for_others_are_not_answered(void)
{
    TEST_ASSERT_EQUAL_UINT(0, take(frame, frame_write(frame, OTHER, 4, "a", 1)));
    TEST_ASSERT_EQUAL_UINT(0, take(frame, frame_write(frame, 0x80 | NODE, 4, "a", 1)));
    TEST_ASSERT_EQUAL_STRING("", hear(4));
}
