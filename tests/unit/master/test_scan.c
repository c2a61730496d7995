/* The master looks for a unit with an address, and for a second one: what comes on the line is written here. */
#include "unity.h"

#include "frames.h"
#include "master.h"

enum {
    NODE = 3,
    BAUD = 19200,
    SCAN_MS = 45,
    ATTEMPTS = 2,
    BYTES_MAX = 64,
    ANSWERS = 0x80,
    SET_COMMAND = 2,
};

#define MS UINT64_C(1000000)

static struct master master;
static uint64_t now_ns;

void setUp(void)
{
    master_init(&master, 1, BAUD, SCAN_MS);
    now_ns = 0;
}

void tearDown(void)
{
}

static uint32_t write_version(uint8_t *bytes, uint8_t number)
{
    return frame_write(bytes, ANSWERS | NODE, number, "\1\0", 2);
}

static void come(uint8_t address, uint8_t number, const char *message)
{
    uint8_t bytes[BYTES_MAX];
    master_take(&master, bytes, frame_write(bytes, address, number, message, 2), now_ns);
}

/* Both Versions of the session have been answered. */
static void scan_until_found(void)
{
    master_scan(&master, NODE, SCAN_MS, ATTEMPTS, now_ns);
    come(ANSWERS | NODE, master.number, "\1\0");
    come(ANSWERS | NODE, master.number, "\1\0");
}

static enum master_end finish(void)
{
    while (master_poll(&master, now_ns) == MASTER_WAITS) {
        now_ns += MS;
    }
    return (enum master_end)master.end;
}

void test_a_unit_is_found_in_a_session_of_its_own(void)
{
    scan_until_found();
    (void)finish();
    scan_until_found();

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, finish());
    TEST_ASSERT_FALSE(master.twice);
    TEST_ASSERT_EQUAL(2, master.answer_length);
    TEST_ASSERT_EQUAL_MEMORY("\1\0", master.answer, 2);
    TEST_ASSERT_EQUAL(2, master.sessions[NODE]);
}

void test_what_is_asked_after_a_scan_goes_in_its_session(void)
{
    static const struct master_order order = {
        .node = NODE, .in_session = true, .length = 1, .patience_ms = SCAN_MS, .attempts = ATTEMPTS};
    scan_until_found();
    (void)finish();
    master.message[0] = SET_COMMAND;
    master_ask(&master, &order, now_ns);
    come(ANSWERS | NODE, master.number, "\0020");

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, master.end);
    TEST_ASSERT_EQUAL(1, master.sessions[NODE]);
}

void test_a_second_answer_is_waited_for_as_long_as_the_first(void)
{
    scan_until_found();
    now_ns += (SCAN_MS - 1) * MS;
    TEST_ASSERT_EQUAL(MASTER_WAITS, master_poll(&master, now_ns));
    now_ns += MS;
    TEST_ASSERT_EQUAL(MASTER_ANSWERED, master_poll(&master, now_ns));
}

void test_two_answers_that_come_together_are_two_units(void)
{
    uint8_t bytes[BYTES_MAX];
    master_scan(&master, NODE, SCAN_MS, ATTEMPTS, now_ns);
    come(ANSWERS | NODE, master.number, "\1\0");
    uint32_t length = write_version(bytes, master.number);
    length += write_version(bytes + length, master.number);
    master_take(&master, bytes, length, now_ns);

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, master.end);
    TEST_ASSERT_TRUE(master.twice);
    TEST_ASSERT_EQUAL(2, master.answer_length);
}

void test_the_next_scan_does_not_remember_that_there_were_two(void)
{
    scan_until_found();
    come(ANSWERS | NODE, master.number, "\1\0");
    TEST_ASSERT_TRUE(master.twice);
    scan_until_found();

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, finish());
    TEST_ASSERT_FALSE(master.twice);
}

void test_a_second_unit_is_found_that_answers_the_version_before(void)
{
    scan_until_found();
    come(ANSWERS | NODE, (uint8_t)(master.number - 1U), "\1\0");

    TEST_ASSERT_TRUE(master.twice);
}

void test_what_else_follows_is_no_second_unit_and_leaves_the_answer_as_it_is(void)
{
    scan_until_found();
    come(ANSWERS | (NODE + 1), master.number, "\1x");
    come(ANSWERS | NODE, master.number, "\4y");
    come(NODE, master.number, "\1z");

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, finish());
    TEST_ASSERT_FALSE(master.twice);
    TEST_ASSERT_EQUAL_MEMORY("\1\0", master.answer, 2);
}

void test_noise_does_not_prolong_the_wait_for_a_second_answer(void)
{
    static const uint8_t noise[] = {0x55, 0xAA, 0x7E};
    scan_until_found();
    while (master_poll(&master, now_ns) == MASTER_WAITS) {
        master_take(&master, noise, sizeof noise, now_ns);
        now_ns += MS;
    }

    TEST_ASSERT_EQUAL(MASTER_ANSWERED, master.end);
    TEST_ASSERT_LESS_OR_EQUAL_UINT64((SCAN_MS + 1) * MS, now_ns);
}

void test_nobody_is_asked_as_often_as_wanted_and_waited_for_as_long(void)
{
    master_scan(&master, NODE, SCAN_MS, ATTEMPTS, now_ns);

    TEST_ASSERT_EQUAL(MASTER_SILENT, finish());
    TEST_ASSERT_EQUAL(ATTEMPTS, master.attempt);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(ATTEMPTS * SCAN_MS * MS, now_ns);
    TEST_ASSERT_LESS_OR_EQUAL_UINT64(ATTEMPTS * (SCAN_MS + 6) * MS, now_ns);
}

void test_two_units_that_talk_at_once_are_damage(void)
{
    uint8_t bytes[BYTES_MAX];
    master_scan(&master, NODE, SCAN_MS, ATTEMPTS, now_ns);
    uint32_t length = write_version(bytes, master.number);
    bytes[3] ^= 1U;
    master_take(&master, bytes, length, now_ns);

    TEST_ASSERT_EQUAL(MASTER_DAMAGED, finish());
}
