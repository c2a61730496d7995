#include "unity.h"

#include <string.h>

#include "pos_registers.h"

/* What lies around the values is somebody else's. */
static struct {
    uint32_t before;
    struct pos_registers registers;
    uint32_t after[4];
} room;

#define registers (room.registers)

void setUp(void)
{
    memset(&room, 0xA5, sizeof room);
    pos_registers_init(&registers);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_HEX32(0xA5A5A5A5, room.before);
    TEST_ASSERT_EACH_EQUAL_HEX32(0xA5A5A5A5, room.after, 4);
}

static uint32_t *axis(unsigned number)
{
    return registers.axes[number - 1U];
}

static uint32_t read_wide(uint32_t number)
{
    uint16_t words[2];
    pos_registers_read(&registers, number, 2, words);
    return ((uint32_t)words[0] << 16U) | words[1];
}

static uint16_t read_one(uint32_t number)
{
    uint16_t word;
    pos_registers_read(&registers, number, 1, &word);
    return word;
}

void test_at_the_start_the_settings_are_as_delivered(void)
{
    TEST_ASSERT_EQUAL_HEX16(1, read_one(0));
    TEST_ASSERT_EQUAL_HEX16(0x0100, read_one(1));
    TEST_ASSERT_EQUAL_HEX16(0x001F, read_one(2));
    TEST_ASSERT_EQUAL_UINT16(0, read_one(30));
    TEST_ASSERT_EQUAL_UINT16(192, read_one(31));
    TEST_ASSERT_EQUAL_UINT16(0, read_one(32));
    TEST_ASSERT_EQUAL_UINT16(0, read_one(40));
    for (uint32_t base = 100; base <= 400; base += 100) {
        TEST_ASSERT_EQUAL_UINT32(1, read_wide(base + 30));
        TEST_ASSERT_EQUAL_UINT32(10, read_wide(base + 32));
        TEST_ASSERT_EQUAL_UINT16(65535, read_one(base + 35));
        TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, read_wide(base + 36));
        TEST_ASSERT_EQUAL_UINT32(600U * 65536U, read_wide(base + 50));
        TEST_ASSERT_EQUAL_UINT32(60U * 65536U, read_wide(base + 52));
        TEST_ASSERT_EQUAL_UINT32(1000000, read_wide(base + 54));
    }
}

void test_at_the_start_all_else_is_0(void)
{
    uint16_t words[30];
    pos_registers_read(&registers, 3, 25, words);
    TEST_ASSERT_EACH_EQUAL_HEX16(0, words, 25);
    for (uint32_t number = 100; number <= 400; number += 100) {
        pos_registers_read(&registers, number, 8, words);
        TEST_ASSERT_EACH_EQUAL_HEX16(0, words, 8);
    }
    pos_registers_read(&registers, 410, 18, words);
    TEST_ASSERT_EACH_EQUAL_HEX16(0, words, 18);
    pos_registers_read(&registers, 438, 12, words);
    TEST_ASSERT_EACH_EQUAL_HEX16(0, words, 12);
}

void test_the_delivered_settings_come_back_and_nothing_else_changes(void)
{
    registers.unit[POS_UNIT_UPTIME] = 77;
    registers.unit[POS_UNIT_RATE] = 96;
    axis(2)[POS_AXIS_POSITION] = 88;
    axis(2)[POS_AXIS_FEED] = 99;
    axis(2)[POS_AXIS_MICROMETRES] = 5;
    pos_registers_deliver(&registers);
    TEST_ASSERT_EQUAL_UINT32(77, read_wide(8));
    TEST_ASSERT_EQUAL_UINT16(192, read_one(31));
    TEST_ASSERT_EQUAL_UINT32(88, read_wide(216));
    TEST_ASSERT_EQUAL_UINT32(99, read_wide(206));
    TEST_ASSERT_EQUAL_UINT32(10, read_wide(232));
}

void test_the_delivered_settings_change_no_other_register(void)
{
    memset(&registers, 0x5A, sizeof registers);
    struct pos_registers before = registers;
    pos_registers_deliver(&registers);
    for (uint32_t number = 0; number < 500U; number++) {
        struct pos_place place;
        if (pos_find(number, &place) && pos_row(&place)->use != (uint8_t)POS_USE_SETTING) {
            TEST_ASSERT_EQUAL_HEX32(*pos_registers_at(&before, &place), *pos_registers_at(&registers, &place));
        }
    }
}

void test_a_value_of_two_registers_has_its_high_word_first(void)
{
    axis(3)[POS_AXIS_POSITION] = 0x12345678;
    TEST_ASSERT_EQUAL_HEX32(0x12345678, read_wide(316));
}

void test_negative_values_are_in_two_s_complement(void)
{
    axis(1)[POS_AXIS_POSITION] = (uint32_t)-4720;
    axis(1)[POS_AXIS_REFERENCE] = (uint32_t)-8;
    TEST_ASSERT_EQUAL_HEX32(0xFFFFED90, read_wide(116));
    TEST_ASSERT_EQUAL_HEX16(0xFFF8, read_one(148));
}

void test_images_show_the_registers_of_all_axes(void)
{
    static const uint16_t fast[16] = {1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 5, 6, 7, 8};
    uint16_t words[32];
    axis(1)[POS_AXIS_STATUS] = 1;
    axis(1)[POS_AXIS_ERROR] = 2;
    axis(1)[POS_AXIS_POSITION] = 0x00030004;
    axis(4)[POS_AXIS_STATUS] = 5;
    axis(4)[POS_AXIS_ERROR] = 6;
    axis(4)[POS_AXIS_POSITION] = 0x00070008;
    pos_registers_read(&registers, 520, 16, words);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(fast, words, 16);
    axis(2)[POS_AXIS_LEN] = 0x00090000;
    pos_registers_read(&registers, 600, 32, words);
    TEST_ASSERT_EQUAL_HEX16(9, words[10]);
    TEST_ASSERT_EQUAL_HEX16(0, words[11]);
}

void test_the_upper_word_of_the_feed_may_be_read_alone(void)
{
    axis(1)[POS_AXIS_FEED] = 0x01F45678;
    TEST_ASSERT_TRUE(pos_registers_may_read(106, 1, false));
    TEST_ASSERT_EQUAL_HEX16(0x01F4, read_one(106));
    TEST_ASSERT_TRUE(pos_registers_may_read(105, 2, false));
    TEST_ASSERT_TRUE(pos_registers_may_read(501, 1, false));
    TEST_ASSERT_TRUE(pos_registers_may_read(600, 7, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(107, 1, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(502, 1, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(607, 2, false));
}

void test_half_of_a_value_is_not_there(void)
{
    TEST_ASSERT_FALSE(pos_registers_may_read(102, 1, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(103, 1, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(100, 3, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(103, 2, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(110, 7, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(520, 3, false));
    TEST_ASSERT_TRUE(pos_registers_may_read(520, 4, false));
    TEST_ASSERT_TRUE(pos_registers_may_read(102, 2, false));
    TEST_ASSERT_TRUE(pos_registers_may_read(110, 18, false));
}

void test_a_range_with_a_register_that_is_not_there_is_not_there(void)
{
    TEST_ASSERT_TRUE(pos_registers_may_read(0, 28, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(0, 29, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(29, 2, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(50, 1, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(511, 2, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(65535, 2, false));
    TEST_ASSERT_FALSE(pos_registers_may_read(65535, 1, false));
}

void test_input_registers_are_those_that_can_only_be_read(void)
{
    TEST_ASSERT_TRUE(pos_registers_may_read(0, 28, true));
    TEST_ASSERT_TRUE(pos_registers_may_read(110, 18, true));
    TEST_ASSERT_TRUE(pos_registers_may_read(520, 16, true));
    TEST_ASSERT_TRUE(pos_registers_may_read(640, 32, true));
    TEST_ASSERT_FALSE(pos_registers_may_read(30, 1, true));
    TEST_ASSERT_FALSE(pos_registers_may_read(100, 8, true));
    TEST_ASSERT_FALSE(pos_registers_may_read(130, 26, true));
    TEST_ASSERT_FALSE(pos_registers_may_read(500, 12, true));
    TEST_ASSERT_FALSE(pos_registers_may_read(600, 32, true));
}

void test_what_can_only_be_read_cannot_be_written(void)
{
    TEST_ASSERT_TRUE(pos_registers_may_write(30, 3));
    TEST_ASSERT_TRUE(pos_registers_may_write(40, 1));
    TEST_ASSERT_TRUE(pos_registers_may_write(100, 8));
    TEST_ASSERT_TRUE(pos_registers_may_write(106, 1));
    TEST_ASSERT_TRUE(pos_registers_may_write(430, 26));
    TEST_ASSERT_TRUE(pos_registers_may_write(500, 12));
    TEST_ASSERT_TRUE(pos_registers_may_write(600, 32));
    TEST_ASSERT_FALSE(pos_registers_may_write(0, 1));
    TEST_ASSERT_FALSE(pos_registers_may_write(110, 1));
    TEST_ASSERT_FALSE(pos_registers_may_write(520, 4));
    TEST_ASSERT_FALSE(pos_registers_may_write(640, 8));
    TEST_ASSERT_FALSE(pos_registers_may_write(102, 1));
    TEST_ASSERT_FALSE(pos_registers_may_write(107, 1));
    TEST_ASSERT_FALSE(pos_registers_may_write(632, 1));
}

void test_every_range_is_there_exactly_if_its_parts_are_and_no_value_is_cut(void)
{
    for (uint32_t first = 0; first < 700; first++) {
        bool all = true;
        for (uint32_t count = 1; count <= 40 && all; count++) {
            struct pos_place place;
            struct pos_place before;
            all = pos_find(first + count - 1U, &place);
            bool cut = all && pos_row_is_wide(pos_row(&place)) && !place.low &&
                       !(place.axis != 0U && place.index == (uint8_t)POS_AXIS_FEED);
            bool begun = pos_find(first, &before) && !before.low;
            TEST_ASSERT_EQUAL(all && begun && !cut, pos_registers_may_read(first, count, false));
        }
    }
}
