/*
 * Damaged frames at a whole unit whose axes are in four states: none is answered, nothing changes, and the unit is in
 * step afterwards.
 *
 * RKM04_LONG=1 tries every pair of wrong bits of the corpus, else some by chance.
 */
#include "pos_wire.h"

enum {
    SOME_PAIRS = 3000,
    LIMIT_PLUS_4 = 447,
    BITS = 8,
};

static uint32_t trials;

/* Axis 1 is held on its way, axis 2 on its measure, axis 3 taken, axis 4 in a fault. */
static void put_axes(void)
{
    const uint16_t input = 1;
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, LIMIT_PLUS_4, 1, &input));
    host_machine_set_input(&machine, 1, true);
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, axis, 0));
        if (axis != 3) {
            TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, axis == 1 ? 10000 : 50, 500, axis));
            TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, UINT32_C(1000) << 16U, 1, axis));
        }
    }
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, UINT32_C(1000) << 16U, 0, 1));
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_HEX(0x0003, rig_status(1));
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(2));
    TEST_ASSERT_EQUAL_HEX(0x0001, rig_status(3));
    TEST_ASSERT_EQUAL_HEX(0x0005, rig_status(4));
    rig_run_ms(10);
}

void setUp(void)
{
    trials = 0;
    rig_set_up();
    rig_run_ms(10);
    put_axes();
    wire_keep();
}

void tearDown(void)
{
    struct wire_frame good = wire_sealed("01 03 00 00 00 01");
    uint32_t frames = unit.server.counts[MODBUS_COUNT_FRAMES];
    wire_send(&good);
    TEST_ASSERT_EQUAL_UINT32(7, rig_heard_count);
    TEST_ASSERT_EQUAL_UINT32(frames + 1U, unit.server.counts[MODBUS_COUNT_FRAMES]);
}

/* What has come since was dropped, each frame once, and has done nothing. */
static void assert_dropped(uint32_t frames)
{
    trials += frames;
    TEST_ASSERT_EQUAL_UINT32(0, rig_heard_count);
    TEST_ASSERT_EQUAL_UINT32(trials, wire_dropped());
    TEST_ASSERT_EQUAL_UINT32(0, wire_counted(MODBUS_COUNT_FRAMES) + wire_counted(MODBUS_COUNT_FOREIGN));
    wire_assert_same();
}

static void assert_frame_dropped(const struct wire_frame *frame)
{
    wire_send(frame);
    assert_dropped(1);
}

static void flip(struct wire_frame *frame, uint32_t bit)
{
    frame->bytes[bit / (uint32_t)BITS] ^= (uint8_t)(1U << (bit % (uint32_t)BITS));
}

void test_no_truncated_request_does_anything(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        const struct wire_frame whole = wire_sealed(modbus_corpus[i]);
        struct wire_frame frame = whole;
        for (frame.length = 1; frame.length < whole.length; frame.length++) {
            assert_frame_dropped(&frame);
        }
        for (uint32_t cut = 1; cut < whole.length; cut++) {
            frame.length = whole.length - cut;
            memcpy(frame.bytes, &whole.bytes[cut], frame.length);
            assert_frame_dropped(&frame);
        }
    }
}

void test_no_request_with_a_wrong_crc_does_anything(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct wire_frame frame = wire_sealed(modbus_corpus[i]);
        for (unsigned trial = 0; trial < 20; trial++) {
            struct wire_frame wrong = frame;
            uint64_t chance = epoch_chance() % 0xFFFFU + 1U;
            wrong.bytes[frame.length - 2U] ^= (uint8_t)(chance & 0xFFU);
            wrong.bytes[frame.length - 1U] ^= (uint8_t)(chance >> 8U);
            assert_frame_dropped(&wrong);
        }
        struct wire_frame swapped = frame;
        swapped.bytes[frame.length - 2U] = frame.bytes[frame.length - 1U];
        swapped.bytes[frame.length - 1U] = frame.bytes[frame.length - 2U];
        if (memcmp(swapped.bytes, frame.bytes, frame.length) != 0) {
            assert_frame_dropped(&swapped);
        }
    }
}

void test_no_request_with_one_wrong_bit_does_anything(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct wire_frame frame = wire_sealed(modbus_corpus[i]);
        for (uint32_t bit = 0; bit < frame.length * (uint32_t)BITS; bit++) {
            flip(&frame, bit);
            assert_frame_dropped(&frame);
            flip(&frame, bit);
        }
    }
}

static void try_pair(struct wire_frame *frame, uint32_t first, uint32_t second)
{
    flip(frame, first);
    flip(frame, second);
    assert_frame_dropped(frame);
    flip(frame, second);
    flip(frame, first);
}

static void try_every_pair(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct wire_frame frame = wire_sealed(modbus_corpus[i]);
        for (uint32_t first = 0; first < frame.length * (uint32_t)BITS; first++) {
            for (uint32_t second = first + 1U; second < frame.length * (uint32_t)BITS; second++) {
                try_pair(&frame, first, second);
            }
        }
    }
}

void test_no_request_with_two_wrong_bits_does_anything(void)
{
    if (getenv("RKM04_LONG") != NULL) {
        try_every_pair();
    }
    for (unsigned trial = 0; trial < (unsigned)SOME_PAIRS; trial++) {
        struct wire_frame frame = wire_sealed(modbus_corpus[epoch_chance() % (unsigned)MODBUS_CORPUS]);
        uint32_t bits = frame.length * (uint32_t)BITS;
        uint32_t first = (uint32_t)(epoch_chance() % bits);
        try_pair(&frame, first, (uint32_t)((first + 1U + epoch_chance() % (bits - 1U)) % bits));
    }
    printf("pairs of wrong bits: %u\n", (unsigned)trials);
}

void test_no_request_with_a_bad_byte_does_anything(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct wire_frame frame = wire_sealed(modbus_corpus[i]);
        for (uint32_t bad = 0; bad < frame.length; bad++) {
            wire_begin();
            wire_put_frame(&frame, (int)bad);
            wire_end();
            assert_dropped(1);
        }
    }
    TEST_ASSERT_EQUAL_UINT32(trials, wire_counted(MODBUS_COUNT_BROKEN));
}

void test_no_request_that_another_one_follows_without_silence_does_anything(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        for (unsigned j = 0; j < (unsigned)MODBUS_CORPUS; j++) {
            struct wire_frame first = wire_sealed(modbus_corpus[i]);
            struct wire_frame second = wire_sealed(modbus_corpus[j]);
            wire_begin();
            wire_put_frame(&first, WIRE_NONE);
            wire_put(second.bytes[0], (i + j) % 2U == 0 ? 0 : WIRE_SILENCE_TICKS - 1U, false);
            memmove(second.bytes, &second.bytes[1], --second.length);
            wire_put_frame(&second, WIRE_NONE);
            wire_end();
            assert_dropped(1);
        }
    }
}

/* A frame with a silence before one of its bytes, which may be bad. */
static void send_with_gap(const struct wire_frame *frame, uint32_t place, uint64_t silence_ticks, bool bad)
{
    wire_begin();
    for (uint32_t i = 0; i < frame->length; i++) {
        wire_put(frame->bytes[i], i == place ? silence_ticks : 0, bad && i == place);
    }
    wire_end();
}

void test_no_request_with_a_silence_of_T_inside_does_anything(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct wire_frame frame = wire_sealed(modbus_corpus[i]);
        for (uint32_t place = 1; place < frame.length; place++) {
            send_with_gap(&frame, place, WIRE_SILENCE_TICKS, false);
            assert_dropped(2);
        }
    }
}

void test_no_request_with_a_pause_and_a_bad_byte_does_anything(void)
{
    static const uint64_t pauses[] = {WIRE_SILENCE_TICKS / 2U, WIRE_SILENCE_TICKS - 1U, WIRE_SILENCE_TICKS};
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct wire_frame frame = wire_sealed(modbus_corpus[i]);
        for (uint32_t place = 1; place < frame.length; place++) {
            send_with_gap(&frame, place, pauses[place % 3U], true);
            assert_dropped(pauses[place % 3U] == WIRE_SILENCE_TICKS ? 2 : 1);
        }
    }
    TEST_ASSERT_EQUAL_UINT32(0, wire_counted(MODBUS_COUNT_PAUSES));
}

/* It is what others make of the same request. */
void test_a_request_with_a_shorter_pause_at_any_place_is_answered_as_without(void)
{
    struct wire_frame frame = wire_sealed("01 04 00 6E 00 08");
    uint8_t answer[RIG_FRAME];
    wire_send(&frame);
    uint32_t length = rig_heard_count;
    memcpy(answer, rig_heard, length);
    TEST_ASSERT_EQUAL_UINT32(21, length);
    for (uint32_t place = 1; place < frame.length; place++) {
        send_with_gap(&frame, place, WIRE_SILENCE_TICKS - 1U, false);
        TEST_ASSERT_EQUAL_UINT32(length, rig_heard_count);
        TEST_ASSERT_EQUAL_MEMORY(answer, rig_heard, length);
        TEST_ASSERT_EQUAL_UINT32(place, wire_counted(MODBUS_COUNT_PAUSES));
    }
    wire_assert_same();
}

void test_no_frame_of_wrong_length_does_anything(void)
{
    struct wire_frame frame = {.length = 1};
    memset(frame.bytes, 0, sizeof frame.bytes);
    for (frame.length = 1; frame.length < 4; frame.length++) {
        assert_frame_dropped(&frame);
    }
    for (uint32_t length = 257; length < 560; length += 101) {
        frame.length = length - 2U;
        memcpy(frame.bytes, "\x01\x10\x00\x64", 4);
        wire_seal(&frame); /* a good CRC does not help */
        assert_frame_dropped(&frame);
    }
    TEST_ASSERT_EQUAL_UINT32(trials, wire_counted(MODBUS_COUNT_LENGTH));
}

void test_no_request_to_another_unit_does_anything(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        for (unsigned address = 2; address < 256; address += i == 0 ? 1U : 49U) {
            struct wire_frame frame;
            frame.length = rig_bytes_of(modbus_corpus[i], frame.bytes);
            frame.bytes[0] = (uint8_t)address;
            wire_seal(&frame);
            wire_send(&frame);
            trials++;
            TEST_ASSERT_EQUAL_UINT32(0, rig_heard_count);
        }
    }
    TEST_ASSERT_EQUAL_UINT32(trials, wire_counted(MODBUS_COUNT_FOREIGN));
    wire_assert_same();
}
