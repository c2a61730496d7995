/* The master before a gateway of Modbus TCP. */
#include "unity.h"

#include <string.h>

#include "pos_master.h"

enum {
    NODE = 3,
    PATIENCE_MS = 3000,
    ATTEMPTS = 4,
};

#define MS UINT64_C(1000000)

static const uint8_t read_two[] = {MODBUS_READ, 0, 10, 0, 2};
static struct pos_master master;
static uint64_t now_ns;

void setUp(void)
{
    const struct pos_master_order order = {
        .node = NODE,
        .length = sizeof read_two,
        .patience_ms = PATIENCE_MS,
        .attempts = ATTEMPTS,
    };
    now_ns = 0;
    pos_master_init(&master, 0, true);
    memcpy(master.request, read_two, sizeof read_two);
    pos_master_ask(&master, &order, now_ns);
    TEST_ASSERT_EQUAL(POS_MASTER_WAITS, pos_master_poll(&master, now_ns));
}

void tearDown(void)
{
}

static enum pos_master_end hear(const uint8_t *bytes, uint32_t length)
{
    master.out_length = 0;
    pos_master_take(&master, bytes, length, now_ns);
    return pos_master_poll(&master, now_ns);
}

void test_a_gateway_is_asked_in_frames_of_modbus_tcp(void)
{
    static const uint8_t asked[] = {0, 1, 0, 0, 0, 6, NODE, MODBUS_READ, 0, 10, 0, 2};
    static const uint8_t old[] = {0, 9, 0, 0, 0, 7, NODE, MODBUS_READ, 4, 9, 9, 9, 9};
    static const uint8_t told[] = {0, 1, 0, 0, 0, 7, NODE, MODBUS_READ, 4, 1, 2, 3, 4};
    TEST_ASSERT_EQUAL(sizeof asked, master.out_length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(asked, master.sent.bytes, sizeof asked);
    TEST_ASSERT_EQUAL(POS_MASTER_WAITS, hear(old, sizeof old));
    TEST_ASSERT_EQUAL(POS_MASTER_WAITS, hear(told, 5));
    TEST_ASSERT_EQUAL(POS_MASTER_ANSWERED, hear(told + 5, sizeof told - 5));
    TEST_ASSERT_EQUAL(6, pos_master_answer_length(&master));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(told + POS_MASTER_TCP_HEAD_BYTES, pos_master_answer(&master), 6);
}

void test_a_repeat_has_another_number_and_goes_at_once(void)
{
    static const uint8_t away[] = {0, 1, 0, 0, 0, 3, NODE, MODBUS_READ | MODBUS_REFUSED, POS_MASTER_AWAY};
    TEST_ASSERT_EQUAL(POS_MASTER_WAITS, hear(away, sizeof away));
    TEST_ASSERT_EQUAL(sizeof read_two + POS_MASTER_TCP_HEAD_BYTES, master.out_length);
    TEST_ASSERT_EQUAL(2, master.sent.bytes[1]);
}

void test_what_is_no_modbus_tcp_is_damage_and_leaves_the_gateway_its_time(void)
{
    static const uint8_t other[] = "HTTP/1.1 400 Bad Request";
    master.order.attempts = 1;
    TEST_ASSERT_EQUAL(POS_MASTER_WAITS, hear(other, sizeof other));
    now_ns = PATIENCE_MS * MS - 1;
    TEST_ASSERT_EQUAL(POS_MASTER_WAITS, pos_master_poll(&master, now_ns));
    now_ns++;
    TEST_ASSERT_EQUAL(POS_MASTER_DAMAGED, pos_master_poll(&master, now_ns));
}
