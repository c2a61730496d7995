#include "unity.h"

#include <string.h>

#include "pos_write.h"

static struct pos_registers registers;
static struct pos_registers before;
static struct pos_write write;

void setUp(void)
{
    pos_registers_init(&registers);
    before = registers;
}

void tearDown(void)
{
}

static bool take(uint32_t first, uint32_t count, const uint16_t *values)
{
    TEST_ASSERT_TRUE(pos_registers_may_write(first, count));
    return pos_write_init(&write, &registers, first, count, values);
}

static bool take_one(uint32_t number, uint16_t value)
{
    return take(number, 1, &value);
}

static bool take_wide(uint32_t number, uint32_t value)
{
    const uint16_t words[2] = {(uint16_t)(value >> 16U), (uint16_t)(value & 0xFFFFU)};
    return take(number, 2, words);
}

static void assert_written(enum pos_use use, uint32_t *next, unsigned axis, unsigned index, uint32_t value)
{
    const struct pos_written *written = pos_write_next(&write, use, next);
    TEST_ASSERT_NOT_NULL(written);
    TEST_ASSERT_EQUAL_UINT8(axis, written->place.axis);
    TEST_ASSERT_EQUAL_UINT8(index, written->place.index);
    TEST_ASSERT_EQUAL_HEX32(value, written->value);
}

/* This value, and no other. */
static void assert_only(enum pos_use use, unsigned axis, unsigned index, uint32_t value)
{
    uint32_t next = 0;
    TEST_ASSERT_EQUAL_UINT32(1, write.count);
    assert_written(use, &next, axis, index, value);
    TEST_ASSERT_NULL(pos_write_next(&write, use, &next));
}

/* ---- ranges ---------------------------------------------------------------------------------------------------- */

struct bounds {
    uint32_t number;
    int64_t min;
    int64_t max;
};

static bool take_of_type(uint32_t number, bool wide, int64_t value)
{
    return wide ? take_wide(number, (uint32_t)value) : take_one(number, (uint16_t)value);
}

static void assert_bounds(const struct bounds *bounds, bool wide, int64_t least, int64_t most)
{
    TEST_ASSERT_TRUE(take_of_type(bounds->number, wide, bounds->min));
    TEST_ASSERT_TRUE(take_of_type(bounds->number, wide, bounds->max));
    if (bounds->min > least) {
        TEST_ASSERT_FALSE(take_of_type(bounds->number, wide, bounds->min - 1));
        TEST_ASSERT_FALSE(take_of_type(bounds->number, wide, least));
    }
    if (bounds->max < most) {
        TEST_ASSERT_FALSE(take_of_type(bounds->number, wide, bounds->max + 1));
        TEST_ASSERT_FALSE(take_of_type(bounds->number, wide, most));
    }
}

void test_each_register_takes_the_values_of_its_range_and_no_others(void)
{
    static const struct bounds unsigned_16[] = {{32, 0, 3},  {40, 1, 2},      {101, 0, 65535}, {104, 0, 65535},
                                                {134, 0, 1}, {135, 1, 65535}, {140, 0, 65535}, {141, 0, 65535}};
    static const struct bounds signed_16[] = {{146, -8, 8}, {147, -8, 8}, {148, -8, 8}, {149, -8, 8}};
    static const struct bounds unsigned_32[] = {{106, 0, UINT32_MAX}, {136, 1, UINT32_MAX}, {138, 0, UINT32_MAX},
                                                {150, 1, UINT32_MAX}, {152, 1, UINT32_MAX}, {154, 1, INT32_MAX}};
    static const struct bounds signed_32[] = {
        {102, INT32_MIN, INT32_MAX}, {142, INT32_MIN, INT32_MAX}, {144, INT32_MIN, INT32_MAX}};
    for (unsigned i = 0; i < sizeof unsigned_16 / sizeof unsigned_16[0]; i++) {
        assert_bounds(&unsigned_16[i], false, 0, 65535);
    }
    for (unsigned i = 0; i < sizeof signed_16 / sizeof signed_16[0]; i++) {
        assert_bounds(&signed_16[i], false, -32768, 32767);
    }
    for (unsigned i = 0; i < sizeof unsigned_32 / sizeof unsigned_32[0]; i++) {
        assert_bounds(&unsigned_32[i], true, 0, UINT32_MAX);
    }
    for (unsigned i = 0; i < sizeof signed_32 / sizeof signed_32[0]; i++) {
        assert_bounds(&signed_32[i], true, INT32_MIN, INT32_MAX);
    }
}

void test_the_watchdog_is_off_or_10_to_60000_ms(void)
{
    for (uint32_t value = 0; value < 65536U; value++) {
        bool good = value == 0U || (value >= 10U && value <= 60000U);
        TEST_ASSERT_EQUAL(good, take_one(30, (uint16_t)value));
    }
}

void test_there_are_five_rates(void)
{
    for (uint32_t value = 0; value < 65536U; value++) {
        bool good = value == 96U || value == 192U || value == 384U || value == 576U || value == 1152U;
        TEST_ASSERT_EQUAL(good, take_one(31, (uint16_t)value));
    }
}

void test_an_instruction_word_has_any_number_and_a_code_up_to_6(void)
{
    for (uint32_t value = 0; value < 65536U; value++) {
        TEST_ASSERT_EQUAL(value % 256U <= 6U, take_one(200, (uint16_t)value));
    }
    TEST_ASSERT_TRUE(take_one(400, 0xFF06));
    assert_only(POS_USE_INSTRUCTION, 4, POS_AXIS_INSTRUCTION, 0xFF06);
}

void test_of_the_control_record_bit_0_counts_and_bits_1_to_3_are_ignored(void)
{
    for (uint32_t value = 0; value < 65536U; value++) {
        TEST_ASSERT_EQUAL(value <= 15U, take_one(105, (uint16_t)value));
    }
    TEST_ASSERT_TRUE(take_one(105, 0x000F));
    assert_only(POS_USE_MOTION, 1, POS_AXIS_CONTROL, 1);
    TEST_ASSERT_TRUE(take_one(503, 0x000E));
    assert_only(POS_USE_MOTION, 2, POS_AXIS_CONTROL, 0);
}

/* Both at once. */
static bool take_factor(uint32_t steps, uint32_t micrometres)
{
    const uint16_t words[4] = {(uint16_t)(steps >> 16U), (uint16_t)(steps & 0xFFFFU), (uint16_t)(micrometres >> 16U),
                               (uint16_t)(micrometres & 0xFFFFU)};
    return take(330, 4, words);
}

void test_the_quotient_of_steps_and_micrometres_is_1_to_10000_up_to_500(void)
{
    TEST_ASSERT_TRUE(take_factor(1, 10000));
    TEST_ASSERT_FALSE(take_factor(1, 10001));
    TEST_ASSERT_TRUE(take_factor(500, 1));
    TEST_ASSERT_FALSE(take_factor(501, 1));
    TEST_ASSERT_TRUE(take_factor(INT32_MAX, INT32_MAX));
    TEST_ASSERT_FALSE(take_factor(INT32_MAX, 4294967));
    TEST_ASSERT_TRUE(take_factor(INT32_MAX, 4294968));
    TEST_ASSERT_TRUE(take_factor(214749, INT32_MAX));
    TEST_ASSERT_FALSE(take_factor(214748, INT32_MAX));
    TEST_ASSERT_FALSE(take_factor(0, 1));
    TEST_ASSERT_FALSE(take_factor(1, 0));
    TEST_ASSERT_FALSE(take_factor(UINT32_C(0x80000000), UINT32_C(0x7FFFFFFF)));
}

void test_a_factor_that_is_written_alone_must_suit_the_other_one(void)
{
    TEST_ASSERT_TRUE(take_wide(330, 5000));
    TEST_ASSERT_FALSE(take_wide(330, 5001));
    TEST_ASSERT_TRUE(take_wide(332, 10000));
    TEST_ASSERT_FALSE(take_wide(332, 10001));
    registers.axes[2][POS_AXIS_STEPS] = 2;
    TEST_ASSERT_TRUE(take_wide(332, 20000));
    TEST_ASSERT_FALSE(take_wide(432, 20000));
}

/* The request before had more values. */
void test_factors_of_another_request_are_of_no_account(void)
{
    static const uint16_t both[] = {0, 500, 0, 1};
    TEST_ASSERT_TRUE(take(330, 4, both));
    TEST_ASSERT_TRUE(take_wide(330, 5000));
    TEST_ASSERT_FALSE(take_wide(330, 5001));
    registers.axes[2][POS_AXIS_MICROMETRES] = 1000000;
    write.written[1].place = (struct pos_place){.axis = 3, .index = POS_AXIS_STEPS};
    TEST_ASSERT_TRUE(take_one(334, 1));
}

/* ---- what is staged -------------------------------------------------------------------------------------------- */

void test_a_negative_value_keeps_its_sign(void)
{
    TEST_ASSERT_TRUE(take_one(148, 0xFFF8));
    assert_only(POS_USE_SETTING, 1, POS_AXIS_REFERENCE, (uint32_t)-8);
    TEST_ASSERT_TRUE(take_wide(202, (uint32_t)-10000));
    assert_only(POS_USE_PARAMETER, 2, POS_AXIS_LEN, (uint32_t)-10000);
}

void test_the_upper_word_of_the_feed_alone_makes_the_lower_one_0(void)
{
    registers.axes[0][POS_AXIS_FEED] = 0x11112222;
    TEST_ASSERT_TRUE(take_one(106, 0x01F4));
    assert_only(POS_USE_MOTION, 1, POS_AXIS_FEED, 0x01F40000);
    pos_write_apply(&write, &registers);
    TEST_ASSERT_EQUAL_HEX32(0x01F40000, registers.axes[0][POS_AXIS_FEED]);
}

void test_the_word_after_those_of_a_request_is_none_of_a_value(void)
{
    const uint16_t words[] = {500, 7};
    TEST_ASSERT_TRUE(take(106, 1, words));
    assert_only(POS_USE_MOTION, 1, POS_AXIS_FEED, 0x01F40000);
}

void test_a_request_is_executed_parameters_first_then_instructions_then_control_and_feed(void)
{
    static const uint16_t values[] = {0x0202, 0, 0, 0x2710, 0x01F4, 1, 0x03E8, 0};
    uint32_t next = 0;
    TEST_ASSERT_TRUE(take(100, 8, values));
    TEST_ASSERT_NULL(pos_write_next(&write, POS_USE_SETTING, &next));
    next = 0;
    assert_written(POS_USE_PARAMETER, &next, 1, POS_AXIS_SPACE, 0);
    assert_written(POS_USE_PARAMETER, &next, 1, POS_AXIS_LEN, 10000);
    assert_written(POS_USE_PARAMETER, &next, 1, POS_AXIS_ACCEL, 500);
    TEST_ASSERT_NULL(pos_write_next(&write, POS_USE_PARAMETER, &next));
    next = 0;
    assert_written(POS_USE_INSTRUCTION, &next, 1, POS_AXIS_INSTRUCTION, 0x0202);
    TEST_ASSERT_NULL(pos_write_next(&write, POS_USE_INSTRUCTION, &next));
    next = 0;
    assert_written(POS_USE_MOTION, &next, 1, POS_AXIS_CONTROL, 1);
    assert_written(POS_USE_MOTION, &next, 1, POS_AXIS_FEED, 0x03E80000);
    TEST_ASSERT_NULL(pos_write_next(&write, POS_USE_MOTION, &next));
}

void test_instructions_come_in_the_order_of_the_axes(void)
{
    uint16_t values[32] = {0};
    uint32_t next = 0;
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        values[axis * 8U] = (uint16_t)(0x0701U + axis);
    }
    TEST_ASSERT_TRUE(take(600, 32, values));
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        assert_written(POS_USE_INSTRUCTION, &next, axis, POS_AXIS_INSTRUCTION, 0x0700U + axis);
    }
    TEST_ASSERT_NULL(pos_write_next(&write, POS_USE_INSTRUCTION, &next));
}

void test_one_wrong_value_makes_all_of_a_request_wrong_and_nothing_changes(void)
{
    uint16_t values[32] = {0};
    for (unsigned wrong = 0; wrong < 32U; wrong += 8U) {
        values[wrong] = 9;
        TEST_ASSERT_FALSE(take(600, 32, values));
        values[wrong] = 0;
        values[wrong + 5U] = 0x10;
        TEST_ASSERT_FALSE(take(600, 32, values));
        values[wrong + 5U] = 0;
    }
    TEST_ASSERT_TRUE(take(600, 32, values));
    TEST_ASSERT_EQUAL_MEMORY(&before, &registers, sizeof registers);
}

void test_all_values_are_applied_but_that_of_store(void)
{
    static const uint16_t settings[] = {500, 1152, 3};
    TEST_ASSERT_TRUE(take(30, 3, settings));
    pos_write_apply(&write, &registers);
    TEST_ASSERT_EQUAL_UINT32(500, registers.unit[POS_UNIT_WATCHDOG]);
    TEST_ASSERT_EQUAL_UINT32(1152, registers.unit[POS_UNIT_RATE]);
    TEST_ASSERT_EQUAL_UINT32(3, registers.unit[POS_UNIT_FORMAT]);
    TEST_ASSERT_TRUE(take_one(40, 1));
    assert_only(POS_USE_STORE, 0, POS_UNIT_STORE, 1);
    pos_write_apply(&write, &registers);
    TEST_ASSERT_EQUAL_UINT32(0, registers.unit[POS_UNIT_STORE]);
}

void test_the_axes_that_settings_and_store_concern_are_told(void)
{
    static const uint16_t parameters[] = {0, 0, 0, 0, 0, 0, 0, 0};
    TEST_ASSERT_TRUE(take_one(30, 0));
    TEST_ASSERT_EQUAL_HEX32(0xF, pos_write_axes(&write));
    TEST_ASSERT_TRUE(take_one(40, 2));
    TEST_ASSERT_EQUAL_HEX32(0xF, pos_write_axes(&write));
    TEST_ASSERT_TRUE(take_one(134, 1));
    TEST_ASSERT_EQUAL_HEX32(0x1, pos_write_axes(&write));
    TEST_ASSERT_TRUE(take_one(434, 1));
    TEST_ASSERT_EQUAL_HEX32(0x8, pos_write_axes(&write));
    TEST_ASSERT_TRUE(take(200, 8, parameters));
    TEST_ASSERT_EQUAL_HEX32(0, pos_write_axes(&write));
}

void test_all_settings_of_an_axis_are_written_at_once(void)
{
    uint16_t values[26];
    pos_registers_read(&registers, 330, 26, values);
    TEST_ASSERT_TRUE(take(330, 26, values));
    TEST_ASSERT_EQUAL_UINT32(17, write.count);
    pos_write_apply(&write, &registers);
    TEST_ASSERT_EQUAL_MEMORY(&before, &registers, sizeof registers);
}

void test_what_is_read_can_be_written_back_and_changes_nothing(void)
{
    uint16_t values[32];
    registers.axes[1][POS_AXIS_LEN] = (uint32_t)-1;
    registers.axes[1][POS_AXIS_FEED] = 0x12345678;
    before = registers;
    pos_registers_read(&registers, 600, 32, values);
    TEST_ASSERT_TRUE(take(600, 32, values));
    pos_write_apply(&write, &registers);
    TEST_ASSERT_EQUAL_MEMORY(&before, &registers, sizeof registers);
}
