/* The master against the link of a unit: the bytes of one are handed to the other, some of them lost or damaged. */
#include "unity.h"

#include <string.h>

#include "frames.h"
#include "link.h"
#include "master.h"

enum {
    NODE = 3,
    BAUD = 19200,
    PATIENCE_MS = 400,
    ATTEMPTS = 4,
    BYTES_MAX = 256,
    FOREVER_MS = 60000,
};

#define MS UINT64_C(1000000)

static struct master master;
static struct link unit;
static uint8_t unit_answer[LINK_ANSWER_BYTES_MAX];
static uint8_t bytes[BYTES_MAX]; /* what the unit has sent */
static uint32_t bytes_length;
static uint64_t now_ns;
static unsigned executed;         /* Set Commands */
static unsigned frames;           /* that the master has sent */
static unsigned requests_to_lose; /* the next ones do not get to the unit */
static unsigned answers_to_lose;
static unsigned answers_to_damage;
static bool echo;
static bool off; /* nobody is there */

void setUp(void)
{
    master_init(&master, 1, BAUD, PATIENCE_MS);
    link_init(&unit, NODE, unit_answer);
    now_ns = 0;
    bytes_length = 0;
    executed = frames = requests_to_lose = answers_to_lose = answers_to_damage = 0;
    echo = off = false;
}

void tearDown(void)
{
}

static bool happens(unsigned *times)
{
    bool does = *times > 0;
    *times -= does ? 1U : 0U;
    return does;
}

static void execute(const struct link_request *request)
{
    executed += request->message[0] == 2 ? 1U : 0U;
    memcpy(unit_answer, request->message, 2);
    if (!request->broadcast) {
        link_answer(&unit, 2);
    }
}

/* What the unit answers to a frame goes to `bytes`. */
static void give_to_unit(void)
{
    struct link_request request;
    uint64_t tick = TICKS_PER_MS * (now_ns / MS);
    for (uint32_t i = 0; i < master.out_length; i++) {
        struct hal_line_byte byte = {.tick = tick, .value = master.out[i]};
        if (link_take(&unit, &byte, &request)) {
            execute(&request);
        }
    }
    (void)link_poll(&unit, tick + LINK_SILENCE_TICKS);
    for (; link_is_sending(&unit); link_advance(&unit)) {
        bytes[bytes_length++] = link_byte(&unit);
    }
}

/* Carries what the master has written, and what comes back. */
static void carry(void)
{
    frames++;
    bytes_length = 0;
    if (echo) {
        memcpy(bytes, master.out, master.out_length);
        bytes_length = master.out_length;
    }
    if (!happens(&requests_to_lose) && !off) {
        uint32_t echoed = bytes_length;
        give_to_unit();
        if (happens(&answers_to_lose)) {
            bytes_length = echoed;
        } else if (happens(&answers_to_damage)) {
            bytes[bytes_length - 3U] ^= 1U;
        }
    }
    master.out_length = 0;
    master_take(&master, bytes, bytes_length, now_ns);
}

static enum master_end finish(void)
{
    for (unsigned ms = 0; ms < FOREVER_MS; ms++) {
        if (master.out_length > 0) {
            carry();
        }
        if (master_poll(&master, now_ns) != MASTER_WAITS) {
            return (enum master_end)master.end;
        }
        now_ns += MS;
    }
    TEST_FAIL_MESSAGE("the request does not end");
    return MASTER_WAITS;
}

static void begin(uint8_t node, bool in_session, const char *message)
{
    struct master_order order = {
        .node = node,
        .in_session = in_session,
        .length = (uint32_t)strlen(message),
        .patience_ms = PATIENCE_MS,
        .attempts = ATTEMPTS,
    };
    memcpy(master.message, message, order.length);
    master_ask(&master, &order, now_ns);
}

static enum master_end ask(const char *message)
{
    begin(NODE, true, message);
    return finish();
}

void test_the_first_request_opens_a_session_by_version_twice(void)
{
    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\2"
                                           "1F1R"));
    TEST_ASSERT_EQUAL(3, frames);
    TEST_ASSERT_EQUAL(1, executed);
    TEST_ASSERT_EQUAL(1, master.sessions[NODE]);
    TEST_ASSERT_EQUAL(2, master.answer_length);
    TEST_ASSERT_EQUAL_MEMORY("\2"
                             "1",
                             master.answer, 2);
}

void test_the_next_request_goes_in_the_same_session(void)
{
    (void)ask("\0011");
    frames = 0;

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0020K"));
    TEST_ASSERT_EQUAL(1, frames);
    TEST_ASSERT_EQUAL(1, master.sessions[NODE]);
}

void test_the_answer_to_version_is_the_second_one(void)
{
    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\1"));
    TEST_ASSERT_EQUAL(2, frames);
}

void test_a_lost_request_is_repeated(void)
{
    (void)ask("\1");
    requests_to_lose = ATTEMPTS - 1;

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0020K"));
    TEST_ASSERT_EQUAL(1, executed);
}

void test_a_request_whose_answers_are_lost_is_executed_once(void)
{
    (void)ask("\1");
    answers_to_lose = ATTEMPTS - 1;

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0020F1R"));
    TEST_ASSERT_EQUAL(1, executed);
}

void test_a_damaged_answer_is_asked_for_again(void)
{
    (void)ask("\1");
    answers_to_damage = 2;

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0020F1R"));
    TEST_ASSERT_EQUAL(1, executed);
}

void test_after_all_attempts_a_unit_is_silent_and_the_next_request_opens_a_session(void)
{
    (void)ask("\1");
    requests_to_lose = frames = 0;
    off = true;
    TEST_ASSERT_EQUAL(MASTER_SILENT, ask("\0020F1R"));
    TEST_ASSERT_EQUAL(ATTEMPTS, frames);
    off = false;

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0020F1R"));
    TEST_ASSERT_EQUAL(2, master.sessions[NODE]);
}

void test_what_is_only_damaged_is_told_as_damaged(void)
{
    (void)ask("\1");
    answers_to_damage = ATTEMPTS;

    TEST_ASSERT_EQUAL(MASTER_DAMAGED, ask("\0044"));
}

void test_the_echo_of_an_adapter_is_no_answer(void)
{
    echo = true;
    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0020K"));

    off = true;
    TEST_ASSERT_EQUAL(MASTER_ECHOED, ask("\0020K"));
}

void test_a_unit_that_has_restarted_is_not_told_again_what_changes_something(void)
{
    (void)ask("\1");
    link_init(&unit, NODE, unit_answer);

    TEST_ASSERT_EQUAL(MASTER_RESTARTED, ask("\0020F1R"));
    TEST_ASSERT_EQUAL(0, executed);
}

void test_what_was_sent_before_the_restart_may_have_been_executed(void)
{
    (void)ask("\1");
    begin(NODE, true, "\0020F1R");
    answers_to_lose = 1;
    carry();
    link_init(&unit, NODE, unit_answer);

    TEST_ASSERT_EQUAL(MASTER_RESTARTED_SENT, finish());
    TEST_ASSERT_EQUAL(1, executed);
}

void test_a_unit_that_has_restarted_is_asked_again_what_only_asks(void)
{
    (void)ask("\1");
    link_init(&unit, NODE, unit_answer);

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0040"));
    TEST_ASSERT_EQUAL(2, master.sessions[NODE]);
}

void test_what_may_be_executed_twice_needs_no_session(void)
{
    begin(NODE, false, "\0020K");

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, finish());
    TEST_ASSERT_EQUAL(1, frames);
    TEST_ASSERT_EQUAL(0, master.sessions[NODE]);
}

void test_nobody_answers_what_goes_to_all_units(void)
{
    (void)ask("\1");
    frames = 0;
    echo = true;
    begin(0, false, "\0020K");

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, finish());
    TEST_ASSERT_EQUAL(1, frames);
    TEST_ASSERT_EQUAL(1, executed);
    TEST_ASSERT_EQUAL(0, master.answer_length);
}

void test_an_answer_that_comes_too_late_is_dropped(void)
{
    uint8_t late[BYTES_MAX];
    (void)ask("\0040");
    master_take(&master, late, frame_write(late, 0x80 | NODE, master.number, "\4x", 2), now_ns);
    TEST_ASSERT_EQUAL_MEMORY("\0040", master.answer, 2);

    master_take(&master, late, 1, now_ns);
    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0040"));
}

void test_an_answer_in_pieces_is_waited_for_beyond_the_first_patience(void)
{
    begin(NODE, false, "\0040");
    give_to_unit();
    master.out_length = 0;
    for (uint32_t i = 0; i < bytes_length; i++) {
        now_ns += 65 * MS;
        TEST_ASSERT_EQUAL(MASTER_WAITS, master_poll(&master, now_ns));
        master_take(&master, bytes + i, 1, now_ns);
    }
    TEST_ASSERT_EQUAL(MASTER_ANSWERED, master_poll(&master, now_ns));
    TEST_ASSERT_GREATER_THAN_UINT64(PATIENCE_MS * MS, now_ns);
}

void test_noise_without_end_ends_a_request_all_the_same(void)
{
    static const uint8_t noise[] = {0x55, 0xAA, 0x7E};
    begin(NODE, false, "\0020K");
    while (master_poll(&master, now_ns) == MASTER_WAITS) {
        master_take(&master, noise, sizeof noise, now_ns);
        now_ns += MS;
    }
    TEST_ASSERT_EQUAL(MASTER_DAMAGED, master.end);
    TEST_ASSERT_LESS_THAN_UINT64(ATTEMPTS * (PATIENCE_MS + 250) * MS, now_ns);
}

void test_who_is_in_a_hurry_repeats_nothing_and_waits_no_longer_than_usual(void)
{
    struct master_order storing = {.node = NODE, .length = 2, .patience_ms = 2500, .attempts = 3};
    memcpy(master.message, "\0031", 2);
    master_ask(&master, &storing, now_ns);
    off = true;
    master_hurry(&master, now_ns);

    TEST_ASSERT_EQUAL(MASTER_SILENT, finish());
    TEST_ASSERT_EQUAL(1, frames);
    TEST_ASSERT_LESS_OR_EQUAL_UINT64((PATIENCE_MS + 20) * MS, now_ns);
}

void test_who_is_in_a_hurry_sends_no_request_after_the_session_was_opened(void)
{
    begin(NODE, true, "\0020F1R");
    master_hurry(&master, now_ns);

    TEST_ASSERT_EQUAL(MASTER_GIVEN_UP, finish());
    TEST_ASSERT_EQUAL(0, executed);
}

void test_a_session_is_opened_with_no_more_than_the_usual_patience(void)
{
    struct master_order storing = {.node = NODE, .in_session = true, .length = 2, .patience_ms = 2500, .attempts = 1};
    memcpy(master.message, "\0031", 2);
    master_ask(&master, &storing, now_ns);
    off = true;

    TEST_ASSERT_EQUAL(MASTER_SILENT, finish());
    TEST_ASSERT_LESS_OR_EQUAL_UINT64((PATIENCE_MS + 20) * MS, now_ns);
}

void test_an_answer_to_an_older_version_alone_begins_no_session(void)
{
    uint8_t old[BYTES_MAX];
    off = true;
    begin(NODE, true, "\0020F1R");
    uint32_t length = frame_write(old, 0x80 | NODE, master.number, "\1\0", 2);
    master_take(&master, old, length, now_ns);
    frames = 0;
    for (unsigned i = 0; i < ATTEMPTS; i++) {
        master_take(&master, old, length, now_ns);
    }

    TEST_ASSERT_EQUAL(MASTER_SILENT, finish());
    TEST_ASSERT_EQUAL(ATTEMPTS, frames);
    TEST_ASSERT_EQUAL(0, executed);
}

void test_an_adapter_that_echoes_is_known_from_then_on(void)
{
    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0020K"));
    TEST_ASSERT_FALSE(master.echoes);
    echo = true;
    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0020K"));
    TEST_ASSERT_TRUE(master.echoes);
    echo = false;
    TEST_ASSERT_EQUAL(MASTER_ANSWERED, ask("\0020K"));
    TEST_ASSERT_TRUE(master.echoes);
}

void test_bytes_that_must_be_escaped_come_back_as_they_were(void)
{
    uint8_t frame[BYTES_MAX];
    begin(NODE, false, "\0040");
    master_take(&master, frame, frame_write(frame, 0x80 | NODE, 0, "\4\x7D\x7E\x5D", 4), now_ns);

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, finish());
    TEST_ASSERT_EQUAL(4, master.answer_length);
    TEST_ASSERT_EQUAL_MEMORY("\4\x7D\x7E\x5D", master.answer, 4);
}

void test_answers_of_others_and_to_others_are_passed_by(void)
{
    uint8_t frame[BYTES_MAX];
    begin(NODE, false, "\0040");
    master_take(&master, frame, frame_write(frame, 0x80 | (NODE + 1), 0, "\4x", 2), now_ns);
    master_take(&master, frame, frame_write(frame, 0x80 | NODE, 7, "\4y", 2), now_ns);
    master_take(&master, frame, frame_write(frame, 0x80 | NODE, 0, "\5z", 2), now_ns);

    TEST_ASSERT_EQUAL(MASTER_WAITS, master.end);
    TEST_ASSERT_EQUAL(MASTER_ANSWERED, finish());
    TEST_ASSERT_EQUAL_MEMORY("\0040", master.answer, 2);
}

void test_the_longest_answer_is_heard(void)
{
    static uint8_t frame[FRAME_BYTES_MAX(LINK_ANSWER_BYTES_MAX)];
    static uint8_t message[LINK_ANSWER_BYTES_MAX];
    memset(message, '~', sizeof message);
    message[0] = 5;
    begin(NODE, false, "\0051");
    master_take(&master, frame, frame_write(frame, 0x80 | NODE, 0, message, sizeof message), now_ns);

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, master.end);
    TEST_ASSERT_EQUAL(sizeof message, master.answer_length);
    TEST_ASSERT_EQUAL_MEMORY(message, master.answer, sizeof message);
}
