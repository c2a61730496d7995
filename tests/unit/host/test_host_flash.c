#include "unity.h"

#include <string.h>

#include "hal_flash.h"
#include "host_machine.h"

enum {
    HALF = HAL_FLASH_AREA_BYTES / 2,
    LAST_WORD = HAL_FLASH_AREA_BYTES - HAL_FLASH_WORD_BYTES
};

static struct host_machine machine;
static const uint8_t word[HAL_FLASH_WORD_BYTES] = {1, 2, 3, 4};

static void assert_bytes(unsigned area, uint32_t offset, uint8_t a, uint8_t b, uint8_t c, uint8_t d)
{
    uint8_t expected[HAL_FLASH_WORD_BYTES] = {a, b, c, d};
    uint8_t bytes[HAL_FLASH_WORD_BYTES];
    hal_flash_read(area, offset, bytes, HAL_FLASH_WORD_BYTES);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, HAL_FLASH_WORD_BYTES);
}

void setUp(void)
{
    host_machine_init(&machine, 0);
    host_machine_select(&machine);
}

void tearDown(void)
{
}

void test_flash_is_erased_at_the_start(void)
{
    TEST_ASSERT_EACH_EQUAL_HEX8(0xFF, machine.flash, sizeof machine.flash);
}

void test_a_word_reads_back_in_the_order_of_its_bytes(void)
{
    TEST_ASSERT_TRUE(hal_flash_write_word(1, LAST_WORD, word));

    assert_bytes(1, LAST_WORD, 1, 2, 3, 4);
    TEST_ASSERT_EQUAL_UINT32(0, machine.flash_rewrites);
}

void test_the_areas_are_apart(void)
{
    TEST_ASSERT_TRUE(hal_flash_write_word(0, 8, word));

    assert_bytes(1, 8, 0xFF, 0xFF, 0xFF, 0xFF);
}

void test_a_word_that_is_not_erased_keeps_its_zeros_and_reports_it(void)
{
    static const uint8_t other[HAL_FLASH_WORD_BYTES] = {0xFF, 2, 3, 4};
    (void)hal_flash_write_word(0, 0, word);

    TEST_ASSERT_FALSE(hal_flash_write_word(0, 0, other));

    assert_bytes(0, 0, 1, 2, 3, 4);
}

void test_a_word_that_only_loses_bits_is_written_but_counted(void)
{
    static const uint8_t zeros[HAL_FLASH_WORD_BYTES] = {0};
    (void)hal_flash_write_word(0, 0, word);

    TEST_ASSERT_TRUE(hal_flash_write_word(0, 0, zeros));

    assert_bytes(0, 0, 0, 0, 0, 0);
    TEST_ASSERT_EQUAL_UINT32(1, machine.flash_rewrites);
}

void test_an_erase_clears_one_whole_area(void)
{
    memset(machine.flash, 0, sizeof machine.flash);

    TEST_ASSERT_TRUE(hal_flash_erase(0));

    TEST_ASSERT_EACH_EQUAL_HEX8(0xFF, machine.flash[0], HAL_FLASH_AREA_BYTES);
    TEST_ASSERT_EACH_EQUAL_HEX8(0, machine.flash[1], HAL_FLASH_AREA_BYTES);
}

void test_words_and_erases_are_counted(void)
{
    (void)hal_flash_write_word(0, 0, word);
    (void)hal_flash_erase(1);

    TEST_ASSERT_EQUAL_UINT32(2, machine.flash_operations);
}

void test_a_power_cut_leaves_half_of_the_word(void)
{
    machine.faults.flash_cut_after = 2;
    (void)hal_flash_write_word(0, 0, word);

    TEST_ASSERT_TRUE(hal_flash_write_word(0, 4, word));

    assert_bytes(0, 0, 1, 2, 3, 4);
    assert_bytes(0, 4, 1, 2, 0xFF, 0xFF);
}

TEST_CASE(HOST_FLASH_LAST_HALF, 0xFF, 0xFF, 3, 4)
TEST_CASE(HOST_FLASH_NOTHING, 0xFF, 0xFF, 0xFF, 0xFF)
TEST_CASE(HOST_FLASH_ALL, 1, 2, 3, 4)
void test_a_power_cut_can_leave_something_else(int done, int a, int b, int c, int d)
{
    machine.faults.flash_cut_after = 1;
    machine.faults.flash_done = (enum host_flash_done)done;

    TEST_ASSERT_TRUE(hal_flash_write_word(0, 0, word));

    assert_bytes(0, 0, (uint8_t)a, (uint8_t)b, (uint8_t)c, (uint8_t)d);
}

void test_after_a_power_cut_nothing_is_done_and_success_reported(void)
{
    machine.faults.flash_cut_after = 1;
    (void)hal_flash_write_word(0, 0, word);

    TEST_ASSERT_TRUE(hal_flash_write_word(0, 4, word));
    TEST_ASSERT_TRUE(hal_flash_erase(0));

    assert_bytes(0, 0, 1, 2, 0xFF, 0xFF);
    assert_bytes(0, 4, 0xFF, 0xFF, 0xFF, 0xFF);
}

void test_a_restart_brings_power_back(void)
{
    machine.faults.flash_cut_after = 1;
    (void)hal_flash_write_word(0, 0, word);
    host_machine_restart(&machine);

    TEST_ASSERT_TRUE(hal_flash_write_word(0, 4, word));

    assert_bytes(0, 4, 1, 2, 3, 4);
    TEST_ASSERT_EQUAL_UINT32(1, machine.flash_operations);
}

void test_a_power_cut_leaves_half_of_an_erase(void)
{
    memset(machine.flash, 0, sizeof machine.flash);
    machine.faults.flash_cut_after = 1;

    TEST_ASSERT_TRUE(hal_flash_erase(1));

    TEST_ASSERT_EACH_EQUAL_HEX8(0xFF, machine.flash[1], HALF);
    TEST_ASSERT_EACH_EQUAL_HEX8(0, &machine.flash[1][HALF], HALF);
}

void test_a_power_cut_can_leave_the_other_half_of_an_erase(void)
{
    memset(machine.flash, 0, sizeof machine.flash);
    machine.faults.flash_cut_after = 1;
    machine.faults.flash_done = HOST_FLASH_LAST_HALF;

    TEST_ASSERT_TRUE(hal_flash_erase(1));

    TEST_ASSERT_EACH_EQUAL_HEX8(0, machine.flash[1], HALF);
    TEST_ASSERT_EACH_EQUAL_HEX8(0xFF, &machine.flash[1][HALF], HALF);
}

void test_one_operation_can_report_an_error(void)
{
    machine.faults.flash_fail_at = 2;

    TEST_ASSERT_TRUE(hal_flash_write_word(0, 0, word));
    TEST_ASSERT_FALSE(hal_flash_write_word(0, 4, word));
    TEST_ASSERT_TRUE(hal_flash_write_word(0, 8, word));

    assert_bytes(0, 4, 1, 2, 0xFF, 0xFF);
}

void test_an_operation_can_report_an_error_and_be_done_all_the_same(void)
{
    memset(machine.flash, 0, sizeof machine.flash);
    machine.faults.flash_fail_at = 1;
    machine.faults.flash_done = HOST_FLASH_ALL;

    TEST_ASSERT_FALSE(hal_flash_erase(0));

    TEST_ASSERT_EACH_EQUAL_HEX8(0xFF, machine.flash[0], HAL_FLASH_AREA_BYTES);
}

void test_one_operation_can_go_wrong_in_silence(void)
{
    machine.faults.flash_silent_at = 1;

    TEST_ASSERT_TRUE(hal_flash_write_word(0, 0, word));
    TEST_ASSERT_TRUE(hal_flash_write_word(0, 4, word));

    assert_bytes(0, 0, 1, 2, 0xFF, 0xFF);
    assert_bytes(0, 4, 1, 2, 3, 4);
}
