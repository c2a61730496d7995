#include "unity.h"

#include "base_crc32.h"

void setUp(void)
{
}

void tearDown(void)
{
}

void test_the_check_value_of_the_standard_comes_out(void)
{
    TEST_ASSERT_EQUAL_HEX32(0xCBF43926, crc32_append(0, (const uint8_t *)"123456789", 9));
}

void test_nothing_leaves_the_crc_alone(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x12345678, crc32_append(0x12345678, (const uint8_t *)"", 0));
}

void test_the_crc_of_parts_is_the_crc_of_the_whole(void)
{
    uint32_t crc = crc32_append(0, (const uint8_t *)"1234", 4);

    TEST_ASSERT_EQUAL_HEX32(0xCBF43926, crc32_append(crc, (const uint8_t *)"56789", 5));
}

/* The definition, bit by bit. */
static uint32_t crc_of_byte(uint8_t byte)
{
    uint32_t rest = UINT32_MAX ^ byte;
    for (unsigned bit = 0; bit < 8; bit++) {
        rest = (rest & 1U) != 0 ? (rest >> 1U) ^ UINT32_C(0xEDB88320) : rest >> 1U;
    }
    return ~rest;
}

void test_every_byte_agrees_with_the_definition(void)
{
    for (unsigned value = 0; value <= UINT8_MAX; value++) {
        uint8_t byte = (uint8_t)value;
        TEST_ASSERT_EQUAL_HEX32(crc_of_byte(byte), crc32_append(0, &byte, 1));
    }
}
