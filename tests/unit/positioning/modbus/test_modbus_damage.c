#include "unity.h"

#include <assert.h>

#include "modbus_corpus.h"
#include "modbus_rig.h"

enum {
    PAIRS_ALL_BITS = 320, /* frames up to this length are hurt at every pair of bits, longer ones at near pairs */
    PAIRS_NEAR_BITS = 40,
};

static_assert(MODBUS_CORPUS == 30, "thirty requests");

static uint32_t trials;

void setUp(void)
{
    rig_set_up();
    trials = 0;
}

void tearDown(void)
{
}

static uint32_t dropped(void)
{
    return server.counts[MODBUS_COUNT_CRC] + server.counts[MODBUS_COUNT_LENGTH] + server.counts[MODBUS_COUNT_BROKEN];
}

/* The frame has come, is over, and was dropped, once. */
static void assert_dropped(void)
{
    trials++;
    TEST_ASSERT_EQUAL_UINT32(trials, dropped());
    TEST_ASSERT_EQUAL_UINT32(0, server.counts[MODBUS_COUNT_FRAMES] + server.counts[MODBUS_COUNT_FOREIGN]);
    TEST_ASSERT_NULL(modbus_next(&server));
    TEST_ASSERT_FALSE(modbus_is_sending(&server));
}

static void assert_frame_dropped(const struct rig_frame *frame)
{
    rig_take_frame(frame);
    assert_dropped();
}

/* A good request is taken again. */
static void assert_in_step(void)
{
    uint32_t frames = server.counts[MODBUS_COUNT_FRAMES];
    rig_take_sealed("01 06 00 64 01 01");
    TEST_ASSERT_NOT_NULL(modbus_next(&server));
    modbus_answer(&server, NULL);
    assert_sent_sealed("01 06 00 64 01 01");
    TEST_ASSERT_EQUAL_UINT32(frames + 1U, server.counts[MODBUS_COUNT_FRAMES]);
}

static void flip(struct rig_frame *frame, uint32_t bit)
{
    frame->bytes[bit / 8U] ^= (uint8_t)(1U << (bit % 8U));
}

void test_every_request_of_the_corpus_is_taken_when_it_is_whole(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        static const uint16_t values[MODBUS_READ_MAX];
        rig_take_sealed(modbus_corpus[i]);
        TEST_ASSERT_EQUAL_UINT32(i + 1U, server.counts[MODBUS_COUNT_FRAMES]);
        if (modbus_next(&server) != NULL) {
            modbus_answer(&server, values);
        }
        (void)rig_poll_in(0);
        (void)rig_sent();
    }
    TEST_ASSERT_EQUAL_UINT32(0, dropped());
}

void test_no_truncated_request_is_executed(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct rig_frame whole = rig_sealed(modbus_corpus[i]);
        struct rig_frame frame = whole;
        for (frame.length = 1; frame.length < whole.length; frame.length++) {
            assert_frame_dropped(&frame);
        }
        for (uint32_t cut = 1; cut < whole.length; cut++) {
            frame.length = whole.length - cut;
            memcpy(frame.bytes, &whole.bytes[cut], frame.length);
            assert_frame_dropped(&frame);
        }
    }
    assert_in_step();
}

void test_no_request_with_one_wrong_bit_is_executed(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct rig_frame frame = rig_sealed(modbus_corpus[i]);
        for (uint32_t bit = 0; bit < frame.length * 8U; bit++) {
            flip(&frame, bit);
            assert_frame_dropped(&frame);
            flip(&frame, bit);
        }
    }
    assert_in_step();
}

void test_no_request_with_two_wrong_bits_is_executed(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct rig_frame frame = rig_sealed(modbus_corpus[i]);
        uint32_t bits = frame.length * 8U;
        uint32_t reach = bits <= PAIRS_ALL_BITS ? bits : PAIRS_NEAR_BITS;
        for (uint32_t first = 0; first < bits; first++) {
            flip(&frame, first);
            for (uint32_t second = first + 1U; second < bits && second <= first + reach; second++) {
                flip(&frame, second);
                assert_frame_dropped(&frame);
                flip(&frame, second);
            }
            flip(&frame, first);
        }
    }
    assert_in_step();
}

void test_no_request_with_a_bad_byte_is_executed(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct rig_frame frame = rig_sealed(modbus_corpus[i]);
        for (uint32_t bad = 0; bad < frame.length; bad++) {
            for (uint32_t place = 0; place < frame.length; place++) {
                rig_take_after(RIG_CHARACTER_TICKS, frame.bytes[place], place == bad);
            }
            rig_wait();
            assert_dropped();
        }
    }
    assert_only(trials, MODBUS_COUNT_BROKEN, 0, MODBUS_COUNTS_TOTAL);
    assert_in_step();
}

void test_no_request_is_executed_that_another_one_follows_without_silence(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        for (unsigned j = 0; j < (unsigned)MODBUS_CORPUS; j++) {
            struct rig_frame first = rig_sealed(modbus_corpus[i]);
            struct rig_frame second = rig_sealed(modbus_corpus[j]);
            rig_take(first.bytes, first.length);
            (void)rig_poll_in(RIG_SILENCE_TICKS - 1U);
            rig_tick -= RIG_SILENCE_TICKS - 1U;
            rig_take_after(RIG_SILENCE_TICKS - 1U + RIG_CHARACTER_TICKS, second.bytes[0], false);
            rig_take(&second.bytes[1], second.length - 1U);
            rig_wait();
            assert_dropped();
        }
    }
    assert_in_step();
}

void test_no_request_with_a_silence_of_T_inside_is_executed(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct rig_frame frame = rig_sealed(modbus_corpus[i]);
        for (uint32_t cut = 1; cut < frame.length; cut++) {
            rig_take(frame.bytes, cut);
            rig_take_after(RIG_SILENCE_TICKS + RIG_CHARACTER_TICKS, frame.bytes[cut], false);
            rig_take(&frame.bytes[cut + 1U], frame.length - cut - 1U);
            rig_wait();
            trials++;
            assert_dropped();
        }
    }
    assert_in_step();
}

void test_every_request_with_shorter_pauses_inside_is_taken_and_the_pause_counted(void)
{
    struct rig_frame frame = rig_sealed("01 06 00 64 01 01");
    for (uint32_t cut = 1; cut < frame.length; cut++) {
        rig_take(frame.bytes, cut);
        (void)rig_poll_in(RIG_SILENCE_TICKS - 1U);
        rig_take_after(RIG_CHARACTER_TICKS, frame.bytes[cut], false);
        rig_take(&frame.bytes[cut + 1U], frame.length - cut - 1U);
        rig_wait();
        TEST_ASSERT_NOT_NULL(modbus_next(&server));
        modbus_answer(&server, NULL);
        assert_sent_sealed("01 06 00 64 01 01");
    }
    assert_only(frame.length - 1U, MODBUS_COUNT_FRAMES, frame.length - 1U, MODBUS_COUNT_PAUSES);
}

void test_the_pauses_of_frames_for_others_are_counted_too(void)
{
    struct rig_frame frame = rig_sealed("02 06 00 64 01 01");
    rig_take(frame.bytes, 2);
    rig_take_after((uint64_t)3 * RIG_CHARACTER_TICKS, frame.bytes[2], false);
    rig_take(&frame.bytes[3], frame.length - 3U);
    rig_wait();
    assert_only(1, MODBUS_COUNT_FOREIGN, 1, MODBUS_COUNT_PAUSES);
}

void test_frames_of_wrong_length_are_counted_and_dropped(void)
{
    static const uint8_t zeros[257];
    rig_take(zeros, 3);
    rig_wait();
    rig_take(zeros, sizeof zeros);
    rig_wait();
    assert_only(2, MODBUS_COUNT_LENGTH, 0, MODBUS_COUNTS_TOTAL);
    assert_in_step();
}

void test_what_comes_before_the_first_silence_is_not_executed(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        rig_start(RIG_RATE_BD, RIG_CHARACTER_BITS);
        rig_take_after(RIG_SILENCE_TICKS, 0x00, false);
        rig_take_sealed(modbus_corpus[i]);
        TEST_ASSERT_NULL(modbus_next(&server));
        assert_nothing_sent();
        assert_only(0, MODBUS_COUNTS_TOTAL, 0, MODBUS_COUNTS_TOTAL);
        assert_in_step();
    }
}
