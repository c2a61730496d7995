#include "unity.h"

#include "frame_vectors.h"
#include "frames.h"
#include "link_sender.h"

static struct link_sender sender;
static uint8_t sent[FRAME_BYTES_MAX(LINK_ANSWER_BYTES_MAX)];
static uint8_t expected[FRAME_BYTES_MAX(LINK_ANSWER_BYTES_MAX)];
static uint8_t message[LINK_ANSWER_BYTES_MAX];

void setUp(void)
{
    link_sender_init(&sender);
}

void tearDown(void)
{
}

static uint32_t drain(void)
{
    uint32_t length = 0;
    while (!link_sender_is_done(&sender)) {
        TEST_ASSERT_LESS_THAN_UINT32(sizeof sent, length);
        sent[length++] = link_sender_byte(&sender);
        link_sender_advance(&sender);
    }
    return length;
}

void test_there_is_nothing_to_send_at_first(void)
{
    TEST_ASSERT_TRUE(link_sender_is_done(&sender));
}

void test_the_shared_frames_come_out(void)
{
    for (unsigned i = 0; i < sizeof frame_vectors / sizeof frame_vectors[0]; i++) {
        const struct frame_vector *vector = &frame_vectors[i];
        link_sender_start(&sender, vector->address, vector->number, (const uint8_t *)vector->message,
                          vector->message_length);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(vector->frame_length, drain(), vector->name);
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(vector->frame, sent, vector->frame_length, vector->name);
    }
}

void test_asking_twice_gives_the_same_byte(void)
{
    uint32_t length = frame_write(expected, 0x83, 0x7E, "\x7D", 1);
    link_sender_start(&sender, 0x83, 0x7E, (const uint8_t *)"\x7D", 1);
    for (uint32_t i = 0; i < length; i++) {
        uint8_t byte = link_sender_byte(&sender);
        TEST_ASSERT_EQUAL_HEX8(byte, link_sender_byte(&sender));
        link_sender_advance(&sender);
    }
    TEST_ASSERT_TRUE(link_sender_is_done(&sender));
}

void test_a_new_start_begins_a_new_frame_in_the_middle_of_one(void)
{
    link_sender_start(&sender, 0x83, 1, (const uint8_t *)"\x7D\x7E", 2);
    for (int i = 0; i < 4; i++) {
        link_sender_advance(&sender);
    }
    link_sender_start(&sender, 0x83, 2, (const uint8_t *)"\x01", 1);
    uint32_t length = frame_write(expected, 0x83, 2, "\x01", 1);
    TEST_ASSERT_EQUAL_UINT32(length, drain());
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, sent, length);
}

TEST_CASE(0x7E)
TEST_CASE(0x7D)
TEST_CASE(0xFF)
void test_the_longest_answer_comes_out_whole(unsigned value)
{
    for (uint32_t i = 0; i < sizeof message; i++) {
        message[i] = (uint8_t)value;
    }
    link_sender_start(&sender, 0x90, 255, message, sizeof message);
    uint32_t length = frame_write(expected, 0x90, 255, message, sizeof message);
    TEST_ASSERT_EQUAL_UINT32(length, drain());
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, sent, length);
}

/* Every pair of neighbours, each of the special bytes among them. */
void test_escapes_at_every_place(void)
{
    static const uint8_t values[] = {0x7E, 0x7D, 0x5E, 0x5D};
    for (unsigned i = 0; i < 1024; i++) {
        uint8_t five[5];
        for (unsigned place = 0; place < sizeof five; place++) {
            five[place] = values[i >> (2U * place) & 3U];
        }
        link_sender_start(&sender, 0x83, 1, five, sizeof five);
        uint32_t length = frame_write(expected, 0x83, 1, five, sizeof five);
        TEST_ASSERT_EQUAL_UINT32(length, drain());
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, sent, length);
    }
}
