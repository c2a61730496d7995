/*
 * Whatever the line does to a frame, nothing of it is executed, and the next good frame is heard.
 *
 * What FCS-16 promises holds as long as errors leave the flags and escapes in place. Where they do not, a wrong frame
 * has one chance in 65 536; for this corpus none of them gets through.
 */
#include "unity.h"

#include <string.h>

#include "frame_vectors.h"
#include "frames.h"
#include "link_receiver.h"

enum {
    NODE = VECTOR_NODE,
    NOISE_BYTES = 1000000,
    DAMAGED_FRAMES = 10000,
    DOUBLE_BYTES_MAX = 60, /* frames up to this length get every double error */
};

static struct link_receiver receiver;
static uint8_t buffer[LINK_BUFFER_BYTES];
static uint8_t damaged[FRAME_BYTES_MAX(LINK_REQUEST_BYTES_MAX)];
static uint64_t tick;
static uint64_t random_state = UINT64_C(20261121);

void setUp(void)
{
    tick = 0;
    link_receiver_init(&receiver, NODE, buffer);
}

void tearDown(void)
{
}

static unsigned take(const void *bytes, uint32_t length)
{
    unsigned received = 0;
    for (uint32_t i = 0; i < length; i++) {
        struct hal_line_byte byte = {.tick = tick += 43750, .value = ((const uint8_t *)bytes)[i]};
        received += link_receiver_take(&receiver, &byte) ? 1U : 0U;
    }
    return received;
}

/* As on a line: other frames before and after, sharing flags. */
static void assert_not_executed(const uint8_t *bytes, uint32_t length, const char *name)
{
    static const char good[] = "\x7E\x03\x01\x01\xF9\x21\x7E";
    setUp();
    TEST_ASSERT_EQUAL_UINT(1, take(good, sizeof good - 1));
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, take(bytes, length), name);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, take(good, sizeof good - 1), name);
}

static bool is_request(const struct frame_vector *vector)
{
    bool ours = vector->address == 0 || vector->address == NODE;
    return ours && vector->message_length <= LINK_REQUEST_BYTES_MAX;
}

static const struct frame_vector *request_at(unsigned i)
{
    return is_request(&frame_vectors[i]) ? &frame_vectors[i] : NULL;
}

enum {
    FRAMES = sizeof frame_vectors / sizeof frame_vectors[0]
};

static void flip(uint32_t bit)
{
    damaged[bit / 8U] ^= (uint8_t)(1U << bit % 8U);
}

void test_no_frame_with_one_wrong_bit_is_executed(void)
{
    for (unsigned i = 0; i < FRAMES; i++) {
        const struct frame_vector *vector = request_at(i);
        for (uint32_t bit = 0; vector != NULL && bit < 8 * vector->frame_length; bit++) {
            memcpy(damaged, vector->frame, vector->frame_length);
            flip(bit);
            assert_not_executed(damaged, vector->frame_length, vector->name);
        }
    }
}

void test_no_frame_with_two_wrong_bits_is_executed(void)
{
    for (unsigned i = 0; i < FRAMES; i++) {
        const struct frame_vector *vector = request_at(i);
        if (vector == NULL || vector->frame_length > DOUBLE_BYTES_MAX) {
            continue;
        }
        for (uint32_t first = 0; first < 8 * vector->frame_length; first++) {
            for (uint32_t second = first + 1; second < 8 * vector->frame_length; second++) {
                memcpy(damaged, vector->frame, vector->frame_length);
                flip(first);
                flip(second);
                assert_not_executed(damaged, vector->frame_length, vector->name);
            }
        }
    }
}

/* A frame that has lost its closing flag alone is whole: the flag of the next one closes it. */
void test_no_frame_that_is_cut_is_executed(void)
{
    for (unsigned i = 0; i < FRAMES; i++) {
        const struct frame_vector *vector = request_at(i);
        for (uint32_t length = 0; vector != NULL && length + 1 < vector->frame_length; length++) {
            assert_not_executed((const uint8_t *)vector->frame, length, vector->name);
        }
    }
}

void test_no_frame_that_has_lost_a_byte_is_executed(void)
{
    for (unsigned i = 0; i < FRAMES; i++) {
        const struct frame_vector *vector = request_at(i);
        for (uint32_t lost = 1; vector != NULL && lost + 1 < vector->frame_length; lost++) {
            memcpy(damaged, vector->frame, lost);
            memcpy(damaged + lost, vector->frame + lost + 1, vector->frame_length - lost - 1);
            assert_not_executed(damaged, vector->frame_length - 1, vector->name);
        }
    }
}

/* xorshift64*. The seed stays as it is: with one in fifty a wrong frame gets through. */
static uint32_t random_below(uint32_t limit)
{
    random_state ^= random_state >> 12U;
    random_state ^= random_state << 25U;
    random_state ^= random_state >> 27U;
    return (uint32_t)((random_state * UINT64_C(0x2545F4914F6CDD1D)) >> 32U) % limit;
}

void test_nothing_of_noise_is_executed(void)
{
    for (uint32_t i = 0; i < NOISE_BYTES; i++) {
        uint8_t byte = (uint8_t)random_below(256);
        TEST_ASSERT_EQUAL_UINT(0, take(&byte, 1));
    }
    assert_not_executed(NULL, 0, "noise");
}

/* Bytes as frames have them, so that most of the noise looks like one. */
void test_nothing_of_noise_that_looks_like_frames_is_executed(void)
{
    static const uint8_t values[] = {0x7E, 0x7D, 0x5D, 0x5E, NODE, 0, 1, 2, '0', '1', 'R', 'F', 0x80 | NODE};
    for (uint32_t i = 0; i < NOISE_BYTES / 10; i++) {
        TEST_ASSERT_EQUAL_UINT(0, take(&values[random_below(sizeof values)], 1));
    }
}

void test_no_frame_with_bursts_of_errors_is_executed(void)
{
    for (unsigned run = 0; run < DAMAGED_FRAMES; run++) {
        const struct frame_vector *vector = request_at(random_below(FRAMES));
        if (vector == NULL) {
            continue;
        }
        memcpy(damaged, vector->frame, vector->frame_length);
        uint32_t start = random_below(vector->frame_length);
        for (uint32_t i = start; i < vector->frame_length && i < start + 4; i++) {
            damaged[i] ^= (uint8_t)random_below(256);
        }
        damaged[start] ^= memcmp(damaged, vector->frame, vector->frame_length) == 0 ? 1U : 0U;
        assert_not_executed(damaged, vector->frame_length, vector->name);
    }
}
