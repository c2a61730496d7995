#include "unity.h"

#include "pos_table.h"

static struct pos_place place;

void setUp(void)
{
}

void tearDown(void)
{
}

static void assert_place(uint32_t number, unsigned axis, unsigned index, bool low)
{
    TEST_ASSERT_TRUE_MESSAGE(pos_find(number, &place), "it is there");
    TEST_ASSERT_EQUAL_UINT8(axis, place.axis);
    TEST_ASSERT_EQUAL_UINT8(index, place.index);
    TEST_ASSERT_EQUAL(low, place.low);
}

void test_a_register_of_the_unit_is_found_by_its_number(void)
{
    assert_place(0, 0, POS_UNIT_LAYOUT, false);
    assert_place(6, 0, POS_UNIT_LATE_STEPS, false);
    assert_place(7, 0, POS_UNIT_LATE_STEPS, true);
    assert_place(27, 0, POS_UNIT_SILENCES, true);
    assert_place(40, 0, POS_UNIT_STORE, false);
}

void test_a_register_of_an_axis_is_found_by_its_number(void)
{
    assert_place(100, 1, POS_AXIS_INSTRUCTION, false);
    assert_place(202, 2, POS_AXIS_LEN, false);
    assert_place(303, 3, POS_AXIS_LEN, true);
    assert_place(407, 4, POS_AXIS_FEED, true);
    assert_place(455, 4, POS_AXIS_HOME_WAY, true);
}

void test_the_fast_image_shows_control_and_feed_and_status_error_and_position(void)
{
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        uint32_t out = 500U + ((axis - 1U) * 3U);
        uint32_t in = 520U + ((axis - 1U) * 4U);
        assert_place(out, axis, POS_AXIS_CONTROL, false);
        assert_place(out + 1U, axis, POS_AXIS_FEED, false);
        assert_place(out + 2U, axis, POS_AXIS_FEED, true);
        assert_place(in, axis, POS_AXIS_STATUS, false);
        assert_place(in + 1U, axis, POS_AXIS_ERROR, false);
        assert_place(in + 2U, axis, POS_AXIS_POSITION, false);
        assert_place(in + 3U, axis, POS_AXIS_POSITION, true);
    }
}

void test_the_full_image_shows_registers_0_to_7_and_10_to_17(void)
{
    for (uint32_t i = 0; i < 8U * POS_AXES; i++) {
        struct pos_place direct;
        TEST_ASSERT_TRUE(pos_find(100U * (i / 8U + 1U) + i % 8U, &direct));
        assert_place(600U + i, direct.axis, direct.index, direct.low);
        TEST_ASSERT_TRUE(pos_find(100U * (i / 8U + 1U) + i % 8U + 10U, &direct));
        assert_place(640U + i, direct.axis, direct.index, direct.low);
    }
}

/* The numbers that are there, from the list of the contract and not from the table. */
static bool is_there(uint32_t number)
{
    uint32_t of_axis = number % 100U;
    if (number < 100U) {
        return number <= 27U || (number >= 30U && number <= 32U) || number == 40U;
    }
    if (number < 500U) {
        return of_axis <= 7U || (of_axis >= 10U && of_axis <= 27U) || (of_axis >= 30U && of_axis <= 55U);
    }
    return number <= 511U || (number >= 520U && number <= 535U) || (number >= 600U && number <= 631U) ||
           (number >= 640U && number <= 671U);
}

void test_what_is_not_listed_is_not_there(void)
{
    for (uint32_t number = 0; number < 65536U + 200U; number++) {
        TEST_ASSERT_EQUAL(is_there(number), pos_find(number, &place));
    }
}

void test_every_register_is_found_at_its_row_s_number(void)
{
    for (uint8_t index = 0; index < (uint8_t)POS_UNIT_REGISTERS; index++) {
        struct pos_place of_unit = {.axis = 0, .index = index};
        assert_place(pos_row(&of_unit)->number, 0, index, false);
    }
    for (uint8_t index = 0; index < (uint8_t)POS_AXIS_REGISTERS; index++) {
        struct pos_place of_axis = {.axis = 3, .index = index};
        assert_place(300U + pos_row(&of_axis)->number, 3, index, false);
    }
}
