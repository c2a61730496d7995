#include "unity.h"

#include <string.h>

#include "frame_vectors.h"
#include "frames.h"
#include "link_receiver.h"

/* What the test puts into the buffer, and after it; nothing may write there. */
enum {
    FILL = 0xA5,
    GUARD_BYTES = 8,
    NODE = VECTOR_NODE
};

#define BYTE_TICKS ((uint64_t)43750)

static struct link_receiver receiver;
static uint8_t buffer[LINK_BUFFER_BYTES + GUARD_BYTES];
static uint8_t frame[FRAME_BYTES_MAX(LINK_ANSWER_BYTES_MAX + 1)];
static uint8_t message[LINK_ANSWER_BYTES_MAX + 1];
static uint64_t tick;
static unsigned received;

void setUp(void)
{
    memset(buffer, FILL, sizeof buffer);
    link_receiver_init(&receiver, NODE, buffer);
    tick = 123456789;
    received = 0;
}

void tearDown(void)
{
    for (unsigned i = 0; i < GUARD_BYTES; i++) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(FILL, buffer[LINK_BUFFER_BYTES + i], "written after the buffer");
    }
}

static void take_after(uint64_t ticks, uint8_t value)
{
    tick += ticks;
    received += link_receiver_take(&receiver, &(struct hal_line_byte){.tick = tick, .value = value}) ? 1U : 0U;
}

static void take_broken(uint8_t value)
{
    tick += BYTE_TICKS;
    struct hal_line_byte byte = {.tick = tick, .value = value, .broken = true};
    received += link_receiver_take(&receiver, &byte) ? 1U : 0U;
}

static void take(const void *bytes, uint32_t length)
{
    for (uint32_t i = 0; i < length; i++) {
        take_after(BYTE_TICKS, ((const uint8_t *)bytes)[i]);
    }
}

/* A frame of `length` bytes that count up from `first`. */
static uint32_t make_frame(uint8_t address, uint32_t length, uint8_t first)
{
    for (uint32_t i = 0; i < length; i++) {
        message[i] = (uint8_t)(first + i);
    }
    return frame_write(frame, address, 1, message, length);
}

static uint32_t errors(void)
{
    uint32_t sum = 0;
    for (unsigned count = 0; count < LINK_COUNTS_TOTAL; count++) {
        sum += count == LINK_COUNT_FRAMES || count == LINK_COUNT_FOREIGN ? 0 : receiver.counts[count];
    }
    return sum;
}

static void assert_the_next_good_frame_is_received(void)
{
    unsigned before = received;
    take("\x7E", 1);
    take(frame, frame_write(frame, NODE, 77, "good", 4));
    TEST_ASSERT_EQUAL_UINT(before + 1, received);
    TEST_ASSERT_EQUAL_UINT8(77, receiver.number);
    TEST_ASSERT_EQUAL_UINT32(4, receiver.length);
    TEST_ASSERT_EQUAL_MEMORY("good", buffer, 4);
}

void test_the_shared_frames_are_received(void)
{
    for (unsigned i = 0; i < sizeof frame_vectors / sizeof frame_vectors[0]; i++) {
        const struct frame_vector *vector = &frame_vectors[i];
        bool ours = vector->address == 0 || vector->address == NODE;
        setUp();
        if (vector->message_length > LINK_REQUEST_BYTES_MAX) {
            continue;
        }
        take(vector->frame, vector->frame_length);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(ours ? 1 : 0, received, vector->name);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(ours ? 0 : 1, receiver.counts[LINK_COUNT_FOREIGN], vector->name);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, errors(), vector->name);
        if (ours) {
            TEST_ASSERT_EQUAL_HEX8(vector->address, receiver.address);
            TEST_ASSERT_EQUAL_HEX8(vector->number, receiver.number);
            TEST_ASSERT_EQUAL_UINT32(vector->message_length, receiver.length);
            TEST_ASSERT_EQUAL_MEMORY(vector->message, buffer, vector->message_length);
        }
    }
}

void test_what_the_shared_vectors_call_dropped_is_counted_and_nothing_else(void)
{
    for (unsigned i = 0; i < sizeof dropped_vectors / sizeof dropped_vectors[0]; i++) {
        const struct dropped_vector *vector = &dropped_vectors[i];
        setUp();
        take(vector->bytes, vector->length);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(0, received, vector->name);
        TEST_ASSERT_NOT_EQUAL_UINT32_MESSAGE(0, receiver.counts[vector->count], vector->name);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(errors(), receiver.counts[vector->count], vector->name);
        assert_the_next_good_frame_is_received();
    }
}

void test_a_frame_ends_with_the_byte_of_its_closing_flag(void)
{
    uint32_t length = make_frame(NODE, 10, 1);
    take(frame, length - 1);
    TEST_ASSERT_EQUAL_UINT(0, received);
    take(frame + length - 1, 1);
    TEST_ASSERT_EQUAL_UINT(1, received);
}

void test_a_frame_for_another_node_does_not_touch_the_buffer(void)
{
    take(frame, make_frame(NODE + 1, 20, 1));
    TEST_ASSERT_EACH_EQUAL_HEX8(FILL, buffer, LINK_BUFFER_BYTES);
}

void test_a_unit_hears_only_its_own_address_and_the_broadcast(void)
{
    for (unsigned address = 0; address <= 0xFF; address++) {
        received = 0;
        take(frame, make_frame((uint8_t)address, 3, 1));
        TEST_ASSERT_EQUAL_UINT(address == 0 || address == NODE ? 1 : 0, received);
    }
}

void test_frames_for_this_unit_are_counted(void)
{
    take(frame, make_frame(NODE, 5, 1));
    take(frame, make_frame(LINK_NODE_BROADCAST, 5, 1));
    take(frame, make_frame(NODE + 1, 5, 1));
    TEST_ASSERT_EQUAL_UINT32(2, receiver.counts[LINK_COUNT_FRAMES]);
}

void test_flags_may_be_shared(void)
{
    uint32_t length = make_frame(NODE, 3, 1);
    take(frame, length);
    take(frame + 1, length - 1);
    take(frame + 1, length - 1);
    TEST_ASSERT_EQUAL_UINT(3, received);
    TEST_ASSERT_EQUAL_UINT32(0, errors());
}

void test_flags_may_be_repeated(void)
{
    uint32_t length = make_frame(NODE, 3, 1);
    for (int i = 0; i < 2000; i++) {
        take("\x7E", 1);
    }
    take(frame, length);
    take("\x7E\x7E\x7E", 3);
    take(frame, length);
    TEST_ASSERT_EQUAL_UINT(2, received);
    TEST_ASSERT_EQUAL_UINT32(0, errors());
}

void test_the_longest_request_is_received(void)
{
    take(frame, make_frame(NODE, LINK_REQUEST_BYTES_MAX, 0));
    TEST_ASSERT_EQUAL_UINT(1, received);
    TEST_ASSERT_EQUAL_UINT32(LINK_REQUEST_BYTES_MAX, receiver.length);
    TEST_ASSERT_EQUAL_MEMORY(message, buffer, LINK_REQUEST_BYTES_MAX);
}

TEST_CASE(1)
TEST_CASE(2)
TEST_CASE(3)
TEST_CASE(200)
void test_a_longer_one_is_dropped(unsigned more)
{
    take(frame, make_frame(NODE, LINK_REQUEST_BYTES_MAX + more, 0));
    TEST_ASSERT_EQUAL_UINT(0, received);
    TEST_ASSERT_EQUAL_UINT32(1, receiver.counts[LINK_COUNT_LONG]);
    TEST_ASSERT_EQUAL_UINT32(1, errors());
    assert_the_next_good_frame_is_received();
}

void test_the_longest_answer_of_another_unit_is_no_error(void)
{
    take(frame, make_frame(0x84, LINK_ANSWER_BYTES_MAX, 0));
    TEST_ASSERT_EQUAL_UINT32(1, receiver.counts[LINK_COUNT_FOREIGN]);
    TEST_ASSERT_EQUAL_UINT32(0, errors());
}

void test_a_longer_answer_of_another_unit_is_one(void)
{
    take(frame, make_frame(0x84, LINK_ANSWER_BYTES_MAX + 1, 0));
    TEST_ASSERT_EQUAL_UINT32(0, receiver.counts[LINK_COUNT_FOREIGN]);
    TEST_ASSERT_EQUAL_UINT32(1, receiver.counts[LINK_COUNT_LONG]);
}

void test_the_shortest_request_has_one_byte(void)
{
    take(frame, make_frame(NODE, 1, 5));
    TEST_ASSERT_EQUAL_UINT(1, received);
    TEST_ASSERT_EQUAL_UINT32(1, receiver.length);
    take(frame, make_frame(NODE, 0, 5));
    TEST_ASSERT_EQUAL_UINT(1, received);
    TEST_ASSERT_EQUAL_UINT32(1, receiver.counts[LINK_COUNT_SHORT]);
}

/* Both flags count as bytes of the frame here. */
void test_a_pause_of_50_ms_is_allowed_before_every_byte(void)
{
    uint32_t length = make_frame(NODE, 6, 0x7B);
    for (uint32_t pause = 1; pause < length; pause++) {
        received = 0;
        take(frame, pause);
        take_after(LINK_GAP_TICKS, frame[pause]);
        take(frame + pause + 1, length - pause - 1);
        TEST_ASSERT_EQUAL_UINT(1, received);
    }
    TEST_ASSERT_EQUAL_UINT32(0, errors());
}

void test_every_byte_may_come_50_ms_after_the_one_before(void)
{
    uint32_t length = make_frame(NODE, 6, 0x7B);
    for (uint32_t i = 0; i < length; i++) {
        take_after(LINK_GAP_TICKS, frame[i]);
    }
    TEST_ASSERT_EQUAL_UINT(1, received);
}

void test_a_longer_pause_drops_the_frame_before_every_byte(void)
{
    for (uint32_t pause = 2; pause < make_frame(NODE, 6, 0x7B); pause++) {
        uint32_t length = make_frame(NODE, 6, 0x7B);
        setUp();
        take(frame, pause);
        take_after(LINK_GAP_TICKS + 1, frame[pause]);
        take(frame + pause + 1, length - pause - 1);
        TEST_ASSERT_EQUAL_UINT(0, received);
        TEST_ASSERT_EQUAL_UINT32(1, receiver.counts[LINK_COUNT_GAP]);
        TEST_ASSERT_EQUAL_UINT32(1, errors());
        assert_the_next_good_frame_is_received();
    }
}

void test_a_flag_and_a_long_pause_open_no_frame(void)
{
    uint32_t length = make_frame(NODE, 6, 1);
    take(frame, 1);
    take_after(LINK_GAP_TICKS + 1, frame[1]);
    take(frame + 2, length - 2);
    TEST_ASSERT_EQUAL_UINT(0, received);
    TEST_ASSERT_EQUAL_UINT32(0, receiver.counts[LINK_COUNT_GAP]);
    TEST_ASSERT_EQUAL_UINT32(length - 2, receiver.counts[LINK_COUNT_STRAY]);
    assert_the_next_good_frame_is_received();
}

void test_a_pause_after_an_escape_that_opens_a_frame_is_a_gap(void)
{
    take("\x7E\x7D", 2);
    take_after(LINK_GAP_TICKS + 1, 0x5E);
    TEST_ASSERT_EQUAL_UINT32(1, receiver.counts[LINK_COUNT_GAP]);
}

void test_the_flag_after_a_long_pause_opens_the_next_frame(void)
{
    uint32_t length = make_frame(NODE, 6, 1);
    take(frame, 5);
    take_after(LINK_GAP_TICKS + 1, 0x7E);
    take(frame + 1, length - 1);
    TEST_ASSERT_EQUAL_UINT(1, received);
    TEST_ASSERT_EQUAL_UINT32(1, receiver.counts[LINK_COUNT_GAP]);
}

void test_a_pause_between_frames_is_no_error(void)
{
    uint32_t length = make_frame(NODE, 6, 1);
    take(frame, length);
    tick += 1000 * LINK_GAP_TICKS;
    take(frame, length);
    TEST_ASSERT_EQUAL_UINT(2, received);
    TEST_ASSERT_EQUAL_UINT32(0, errors());
}

void test_a_broken_byte_drops_the_frame_at_every_place(void)
{
    for (uint32_t place = 0; place < make_frame(NODE, 6, 0x7B); place++) {
        uint32_t length = make_frame(NODE, 6, 0x7B);
        setUp();
        take("\x7E", 1);
        take(frame, place);
        take_broken(frame[place]);
        take(frame + place + 1, length - place - 1);
        TEST_ASSERT_EQUAL_UINT(0, received);
        TEST_ASSERT_EQUAL_UINT32(1, receiver.counts[LINK_COUNT_BROKEN]);
        TEST_ASSERT_EQUAL_UINT32(1, errors());
        assert_the_next_good_frame_is_received();
    }
}

/* Every combination of special and harmless bytes at five places. */
void test_escapes_at_every_place(void)
{
    static const uint8_t values[] = {0x7E, 0x7D, 0x5E, 0x5D};
    for (unsigned i = 0; i < 1024; i++) {
        for (unsigned place = 0; place < 5; place++) {
            message[place] = values[i >> (2U * place) & 3U];
        }
        received = 0;
        take(frame, frame_write(frame, NODE, values[i & 3U], message, 5));
        TEST_ASSERT_EQUAL_UINT(1, received);
        TEST_ASSERT_EQUAL_HEX8(values[i & 3U], receiver.number);
        TEST_ASSERT_EQUAL_MEMORY(message, buffer, 5);
    }
    TEST_ASSERT_EQUAL_UINT32(0, errors());
}

void test_only_flags_and_escapes_may_be_escaped(void)
{
    for (unsigned value = 0; value <= 0xFF; value++) {
        setUp();
        take("\x7E\x7D", 2);
        take_after(BYTE_TICKS, (uint8_t)value);
        bool allowed = value == 0x5E || value == 0x5D;
        TEST_ASSERT_EQUAL_UINT32(allowed || value == 0x7E ? 0 : 1, receiver.counts[LINK_COUNT_ESCAPE]);
        TEST_ASSERT_EQUAL_UINT32(value == 0x7E ? 1 : 0, receiver.counts[LINK_COUNT_ABORT]);
    }
}

void test_every_count_has_a_text(void)
{
    for (unsigned count = 0; count < LINK_COUNTS_TOTAL; count++) {
        TEST_ASSERT_NOT_EQUAL_size_t(0, strlen(link_count_text((enum link_count)count)));
    }
}
