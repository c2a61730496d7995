#include "unity.h"

#include "gve_big.h"

enum {
    WORD_BITS = 32,
    BITS = GVE_BIG_WORDS * WORD_BITS,
    QUOTIENT_BITS = 31,
};

void setUp(void)
{
}

void tearDown(void)
{
}

static void assert_quotient(uint32_t floor, uint32_t nearest, uint32_t numerator, uint32_t denominator)
{
    struct gve_quotient quotient = gve_big_divide(gve_big_of(numerator), gve_big_of(denominator), QUOTIENT_BITS);
    TEST_ASSERT_EQUAL_UINT32(floor, quotient.floor);
    TEST_ASSERT_EQUAL_UINT32(nearest, quotient.nearest);
}

void test_a_quotient_without_a_remainder_is_that_both_rounded_down_and_to_the_nearest(void)
{
    assert_quotient(1, 1, 1, 1);
    assert_quotient(1000000000, 1000000000, 1000000000, 1);
    assert_quotient(613566756, 613566756, 4294967292, 7);
    assert_quotient(0, 0, 0, 7);
}

void test_a_quotient_is_rounded_to_the_nearest_and_a_half_to_the_even_one(void)
{
    assert_quotient(1, 1, 5, 4);
    assert_quotient(1, 2, 7, 4);
    assert_quotient(0, 0, 1, 2);
    assert_quotient(1, 2, 3, 2);
    assert_quotient(2, 2, 5, 2);
}

void test_the_largest_quotient_has_as_many_bits_as_are_asked_for(void)
{
    assert_quotient(INT32_MAX, INT32_MAX, INT32_MAX, 1);
    struct gve_quotient quotient = gve_big_divide(gve_big_of(5), gve_big_of(3), 1);
    TEST_ASSERT_EQUAL_UINT32(1, quotient.floor);
    TEST_ASSERT_EQUAL_UINT32(2, quotient.nearest);
}

void test_0_has_no_bits_and_each_power_of_two_one_more_than_the_one_before(void)
{
    struct gve_big value = gve_big_of(0);
    TEST_ASSERT_EQUAL_UINT32(0, gve_big_bits(&value));
    value = gve_big_of(1);
    for (uint32_t bits = 1; bits < BITS; bits++) {
        TEST_ASSERT_EQUAL_UINT32(bits, gve_big_bits(&value));
        gve_big_shift_left(&value, 1);
    }
    TEST_ASSERT_EQUAL_UINT32(BITS, gve_big_bits(&value));
}

void test_all_words_count_where_two_numbers_are_compared(void)
{
    for (uint32_t bits = 0; bits < BITS; bits++) {
        struct gve_big a = gve_big_of(1);
        gve_big_shift_left(&a, bits);
        struct gve_big b = a;
        TEST_ASSERT_EQUAL(0, gve_big_compare(&a, &b));
        b.words[0] ^= 2U; /* more, but where that takes away the only bit */
        TEST_ASSERT_EQUAL(bits == 1, gve_big_compare(&a, &b) > 0);
        TEST_ASSERT_EQUAL(bits == 1, gve_big_compare(&b, &a) < 0);
    }
}
