#include "base_text.h"
#include "unity.h"

#include <string.h>

enum {
    CAPACITY = 32,
    GUARD = 0x5A
};

static uint8_t buffer[CAPACITY + 1];
static struct text text;

static void begin(uint32_t capacity)
{
    memset(buffer, GUARD, sizeof buffer);
    text_init(&text, buffer, capacity);
}

void setUp(void)
{
    begin(CAPACITY);
}

/* Nothing is ever written after the text. */
void tearDown(void)
{
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(text.capacity, text.length);
    TEST_ASSERT_EACH_EQUAL_HEX8(GUARD, &buffer[text.length], sizeof buffer - text.length);
}

static void assert_text(const char *expected)
{
    TEST_ASSERT_EQUAL_UINT32(strlen(expected), text.length);
    if (text.length > 0) {
        TEST_ASSERT_EQUAL_STRING_LEN(expected, (const char *)buffer, text.length);
    }
}

static void assert_unsigned(const char *expected, uint64_t value, uint32_t width)
{
    begin(CAPACITY);
    text_put_unsigned(&text, value, width);
    assert_text(expected);
}

static void assert_signed(const char *expected, int64_t value, uint32_t width)
{
    begin(CAPACITY);
    text_put_signed(&text, value, width);
    assert_text(expected);
}

void test_a_new_text_is_empty(void)
{
    assert_text("");
}

void test_bytes_and_strings_follow_each_other(void)
{
    text_put_byte(&text, 'a');
    text_put_string(&text, "bc");
    text_put_string(&text, "");
    text_put_byte(&text, 'd');
    assert_text("abcd");
}

void test_numbers_have_no_leading_zeros(void)
{
    assert_unsigned("0", 0, 0);
    assert_unsigned("1", 1, 0);
    assert_unsigned("9", 9, 0);
    assert_unsigned("10", 10, 0);
    assert_unsigned("99", 99, 0);
    assert_unsigned("100", 100, 0);
    assert_unsigned("1002003", 1002003, 0);
}

void test_every_power_of_ten_and_the_number_below_it_are_written_right(void)
{
    char ones[CAPACITY] = "1";
    char nines[CAPACITY] = "";
    uint64_t power = 1;
    for (unsigned digits = 1; digits < 20; digits++) {
        power *= 10U;
        memset(&ones[1], '0', digits);
        memset(nines, '9', digits);
        assert_unsigned(ones, power, 0);
        assert_unsigned(nines, power - 1U, 0);
    }
}

void test_every_digit_is_written(void)
{
    assert_unsigned("9876543210", UINT64_C(9876543210), 0);
    assert_unsigned("12345678901234567890", UINT64_C(12345678901234567890), 0);
}

void test_the_largest_and_the_smallest_numbers_are_written_right(void)
{
    assert_unsigned("18446744073709551615", UINT64_MAX, 0);
    assert_signed("9223372036854775807", INT64_MAX, 0);
    assert_signed("-9223372036854775808", INT64_MIN, 0);
}

void test_signed_numbers_have_a_minus_only(void)
{
    assert_signed("0", 0, 0);
    assert_signed("1", 1, 0);
    assert_signed("-1", -1, 0);
}

void test_numbers_are_right_aligned_in_their_width(void)
{
    assert_unsigned("         0", 0, 10);
    assert_unsigned(" 5", 5, 2);
    assert_signed("   -5", -5, 5);
}

void test_a_number_as_long_as_its_width_has_no_blank(void)
{
    assert_unsigned("14", 14, 2);
    assert_signed("-4", -4, 2);
}

void test_a_number_longer_than_its_width_is_not_cut(void)
{
    assert_signed("-1234567890", -1234567890, 10);
}

void test_a_hexadecimal_has_as_many_of_its_lowest_digits_as_are_wanted(void)
{
    begin(CAPACITY);
    text_put_hex(&text, 0x89ABCDEF, 8);
    text_put_hex(&text, 0x4F2, 2);
    text_put_hex(&text, 0, 1);
    assert_text("89ABCDEFF20");
}

void test_what_does_not_fit_is_left_out(void)
{
    begin(3);
    text_put_string(&text, "ab");
    text_put_unsigned(&text, 1234, 0);
    text_put_byte(&text, 'c');
    assert_text("ab1");
}

void test_a_full_text_takes_nothing(void)
{
    begin(0);
    text_put_byte(&text, 'a');
    text_put_signed(&text, -1, 4);
    assert_text("");
}
