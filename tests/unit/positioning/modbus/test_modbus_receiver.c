#include "unity.h"

#include <string.h>

#include "modbus_crc.h"
#include "modbus_receiver.h"

static struct modbus_receiver receiver;
static uint64_t tick;

static const uint8_t good_frame[] = {0x01, 0x06, 0x00, 0x64, 0x01, 0x01, 0x08, 0x45};

/* A rate and a format, and the times that follow, rounded down. */
struct times {
    uint32_t rate_bd;
    uint32_t bits;
    uint32_t character;
    uint32_t silence;
    uint32_t pause;
};

static const struct times all_times[] = {
    {9600, 11, 96250, 336875, 144375}, {9600, 10, 87500, 306250, 131250}, {19200, 11, 48125, 168437, 72187},
    {19200, 10, 43750, 153125, 65625}, {38400, 11, 24062, 147000, 63000}, {38400, 10, 21875, 147000, 63000},
    {57600, 11, 16041, 147000, 63000}, {57600, 10, 14583, 147000, 63000}, {115200, 11, 8020, 147000, 63000},
    {115200, 10, 7291, 147000, 63000},
};

enum {
    TIMES = sizeof all_times / sizeof all_times[0],
};

static void begin(const struct times *times)
{
    modbus_receiver_init(&receiver, times->rate_bd, times->bits, tick);
    tick += (uint64_t)times->character + times->silence;
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_NOTHING, modbus_receiver_wait(&receiver, tick, false));
}

/* A byte whose end is so long after the end of the one before. */
static enum modbus_received take_after(uint64_t ticks, uint8_t value, bool broken)
{
    tick += ticks;
    struct hal_line_byte byte = {.tick = tick, .value = value, .broken = broken};
    enum modbus_received received = modbus_receiver_wait_byte(&receiver, &byte);
    modbus_receiver_take(&receiver, &byte);
    return received;
}

static void take_all(const uint8_t *bytes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL(MODBUS_RECEIVED_NOTHING, take_after(receiver.character_ticks, bytes[i], false));
    }
}

static void take_good(void)
{
    take_all(good_frame, sizeof good_frame);
}

static enum modbus_received wait_in(uint64_t ticks)
{
    tick += ticks;
    return modbus_receiver_wait(&receiver, tick, false);
}

static enum modbus_received wait_long(void)
{
    return wait_in((uint64_t)10 * TICKS_PER_MS);
}

void setUp(void)
{
    tick = 98765432109;
    begin(&all_times[2]);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_NOTHING, wait_long());
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, modbus_receiver_wake(&receiver, tick));
}

void test_the_crc_of_the_check_text_is_4B37(void)
{
    uint16_t crc = MODBUS_CRC_START;
    for (const char *c = "123456789"; *c != '\0'; c++) {
        crc = modbus_crc_append(crc, (uint8_t)*c);
    }
    TEST_ASSERT_EQUAL_HEX16(0x4B37, crc);
}

void test_the_times_follow_from_rate_and_format(void)
{
    for (unsigned i = 0; i < (unsigned)TIMES; i++) {
        begin(&all_times[i]);
        TEST_ASSERT_EQUAL_UINT32(all_times[i].character, receiver.character_ticks);
        TEST_ASSERT_EQUAL_UINT32(all_times[i].silence, receiver.silence_ticks);
        TEST_ASSERT_EQUAL_UINT32(all_times[i].pause, receiver.pause_ticks);
    }
}

void test_a_byte_that_began_after_a_silence_of_T_ends_the_frame_and_begins_one(void)
{
    for (unsigned i = 0; i < (unsigned)TIMES; i++) {
        begin(&all_times[i]);
        take_good();
        TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME,
                          take_after((uint64_t)all_times[i].character + all_times[i].silence, 0x01, false));
        TEST_ASSERT_EQUAL_UINT16(1, receiver.length);
        take_all(&good_frame[1], sizeof good_frame - 1);
        TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
    }
}

void test_a_byte_that_began_a_tick_before_T_belongs_to_the_frame_with_a_pause(void)
{
    for (unsigned i = 0; i < (unsigned)TIMES; i++) {
        begin(&all_times[i]);
        take_all(good_frame, 4);
        TEST_ASSERT_EQUAL(MODBUS_RECEIVED_NOTHING,
                          take_after((uint64_t)all_times[i].character + all_times[i].silence - 1U, 0x01, false));
        take_all(&good_frame[5], 3);
        TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
        TEST_ASSERT_TRUE(receiver.paused);
        TEST_ASSERT_EQUAL_UINT16(sizeof good_frame, receiver.length);
    }
}

void test_a_frame_has_come_with_T_of_silence_where_no_byte_is_on_its_way(void)
{
    for (unsigned i = 0; i < (unsigned)TIMES; i++) {
        for (uint32_t bytes = 4; bytes <= sizeof good_frame; bytes += 4) {
            begin(&all_times[i]);
            take_all(good_frame, bytes);
            uint64_t end = tick + all_times[i].silence;
            TEST_ASSERT_EQUAL_UINT64(end, modbus_receiver_wake(&receiver, tick));
            TEST_ASSERT_EQUAL_UINT64(end, modbus_receiver_wake(&receiver, end - 1U));
            TEST_ASSERT_EQUAL(MODBUS_RECEIVED_NOTHING, modbus_receiver_wait(&receiver, end - 1U, true));
            TEST_ASSERT_EQUAL(bytes == sizeof good_frame ? MODBUS_RECEIVED_FRAME : MODBUS_RECEIVED_CRC,
                              modbus_receiver_wait(&receiver, end, true));
            TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, modbus_receiver_wake(&receiver, end));
            tick = end;
        }
    }
}

void test_a_byte_that_may_be_on_its_way_is_waited_for(void)
{
    for (unsigned i = 0; i < (unsigned)TIMES; i++) {
        begin(&all_times[i]);
        take_good();
        uint64_t end = (uint64_t)all_times[i].character + all_times[i].silence;
        TEST_ASSERT_EQUAL_UINT64(tick + end, modbus_receiver_wake(&receiver, tick + all_times[i].silence));
        TEST_ASSERT_EQUAL_UINT64(tick + end, modbus_receiver_wake(&receiver, tick + end - 1U));
        TEST_ASSERT_EQUAL(MODBUS_RECEIVED_NOTHING, wait_in(end - 1U));
        TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_in(1));
    }
}

void test_a_silence_over_one_and_a_half_characters_is_a_pause(void)
{
    for (unsigned i = 0; i < (unsigned)TIMES; i++) {
        for (uint32_t over = 0; over < 2; over++) {
            begin(&all_times[i]);
            take_all(good_frame, 7);
            (void)take_after((uint64_t)all_times[i].character + all_times[i].pause + over, 0x45, false);
            TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
            TEST_ASSERT_EQUAL(over == 1, receiver.paused);
        }
    }
}

void test_the_pause_of_one_frame_is_not_that_of_the_next(void)
{
    take_all(good_frame, 7);
    (void)take_after((uint64_t)3 * receiver.character_ticks, 0x45, false);
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
    TEST_ASSERT_TRUE(receiver.paused);
    take_good();
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
    TEST_ASSERT_FALSE(receiver.paused);
}

void test_nothing_is_received_before_the_bus_has_been_silent_for_T_since_the_start(void)
{
    modbus_receiver_init(&receiver, 19200, 11, tick);
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_NOTHING, wait_in(100));
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, modbus_receiver_wake(&receiver, tick));
    (void)take_after((uint64_t)receiver.silence_ticks, 0x55, false);
    take_good();
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_NOTHING, wait_long());
    take_good();
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
}

void test_the_first_byte_may_come_as_soon_as_the_bus_has_been_silent_for_T(void)
{
    modbus_receiver_init(&receiver, 19200, 11, tick);
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_NOTHING,
                      take_after((uint64_t)receiver.silence_ticks + receiver.character_ticks, 0x01, false));
    take_all(&good_frame[1], sizeof good_frame - 1);
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
}

void test_a_bad_byte_at_any_place_breaks_the_frame_and_no_other(void)
{
    for (uint32_t bad = 0; bad < sizeof good_frame; bad++) {
        for (uint32_t i = 0; i < sizeof good_frame; i++) {
            (void)take_after(receiver.character_ticks, good_frame[i], i == bad);
        }
        TEST_ASSERT_EQUAL(MODBUS_RECEIVED_BROKEN, wait_long());
        take_good();
        TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
    }
}

/* A frame of zeros and the CRC of these. */
static void take_zeros(uint32_t count)
{
    uint16_t crc = MODBUS_CRC_START;
    static const uint8_t zero = 0;
    for (uint32_t i = 0; i + 2U < count; i++) {
        crc = modbus_crc_append(crc, zero);
        take_all(&zero, 1);
    }
    const uint8_t end[] = {(uint8_t)(crc & 0xFFU), (uint8_t)(crc >> 8U)};
    take_all(end, sizeof end);
}

void test_frames_have_4_to_256_bytes(void)
{
    take_zeros(3);
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_LENGTH, wait_long());
    take_zeros(4);
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
    take_zeros(256);
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
    TEST_ASSERT_EQUAL_UINT16(256, receiver.length);
    take_zeros(257);
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_LENGTH, wait_long());
    take_zeros(70000);
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_LENGTH, wait_long());
}

void test_bytes_stay_from_the_end_of_the_frame_to_the_next_byte(void)
{
    take_good();
    TEST_ASSERT_EQUAL(MODBUS_RECEIVED_FRAME, wait_long());
    (void)wait_long();
    TEST_ASSERT_EQUAL_HEX8_ARRAY(good_frame, receiver.bytes, sizeof good_frame);
}
