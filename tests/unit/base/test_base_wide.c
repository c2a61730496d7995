#include "base_wide.h"
#include "unity.h"

/* The numbers that expected values stand for were worked out with whole numbers of any length. */

#define LENGTH(array) (sizeof(array) / sizeof(array)[0])

static struct wide wide(uint64_t high, uint64_t low)
{
    return (struct wide){.high = high, .low = low};
}

static void assert_equal_wide(struct wide expected, struct wide actual)
{
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(expected.high, actual.high, "high word");
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(expected.low, actual.low, "low word");
}

/* Words at and beside the places where carries are made. */
static const uint64_t edges[] = {
    0,
    1,
    2,
    3,
    UINT32_MAX,
    UINT64_C(0x100000000),
    UINT64_C(0x100000001),
    UINT64_C(0x7FFFFFFFFFFFFFFF),
    UINT64_C(0x8000000000000000),
    UINT64_C(0x8000000000000001),
    UINT64_C(0xB504F333F9DE6484),
    UINT64_MAX - 1U,
    UINT64_MAX,
};

void setUp(void)
{
}

void tearDown(void)
{
}

void test_a_wrapping_number_is_read_as_signed(void)
{
    TEST_ASSERT_EQUAL_INT64(0, wide_to_signed(0));
    TEST_ASSERT_EQUAL_INT64(5, wide_to_signed(5));
    TEST_ASSERT_EQUAL_INT64(-1, wide_to_signed(UINT64_MAX));
    TEST_ASSERT_EQUAL_INT64(-5, wide_to_signed(UINT64_MAX - 4U));
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, wide_to_signed(UINT64_C(0x7FFFFFFFFFFFFFFF)));
    TEST_ASSERT_EQUAL_INT64(INT64_MIN, wide_to_signed(UINT64_C(0x8000000000000000)));
}

void test_a_signed_number_becomes_its_wrapping_form(void)
{
    TEST_ASSERT_EQUAL_HEX64(UINT64_MAX, wide_from_signed(-1));
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0x8000000000000000), wide_from_signed(INT64_MIN));
    TEST_ASSERT_EQUAL_HEX64(INT64_MAX, wide_from_signed(INT64_MAX));
}

void test_the_two_readings_undo_each_other(void)
{
    for (unsigned i = 0; i < LENGTH(edges); i++) {
        TEST_ASSERT_EQUAL_HEX64(edges[i], wide_from_signed(wide_to_signed(edges[i])));
    }
}

void test_a_wrapping_32_bit_number_is_read_as_signed(void)
{
    TEST_ASSERT_EQUAL_INT32(0, wide_to_signed_32(0));
    TEST_ASSERT_EQUAL_INT32(-1, wide_to_signed_32(UINT32_MAX));
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, wide_to_signed_32(0x7FFFFFFFU));
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, wide_to_signed_32(0x80000000U));
}

void test_a_number_has_bits_up_to_its_highest_1(void)
{
    TEST_ASSERT_EQUAL_UINT(0, wide_bits(0));
    for (unsigned bits = 1; bits <= 32; bits++) {
        uint32_t lowest = UINT32_C(1) << (bits - 1U);
        TEST_ASSERT_EQUAL_UINT(bits, wide_bits(lowest));
        TEST_ASSERT_EQUAL_UINT(bits, wide_bits(lowest + (lowest - 1U)));
    }
}

void test_products_are_exact(void)
{
    assert_equal_wide(wide(0, 6), wide_multiply(2, 3));
    assert_equal_wide(wide(1, 0), wide_multiply(UINT64_C(0x100000000), UINT64_C(0x100000000)));
    assert_equal_wide(wide(0, UINT64_MAX), wide_multiply(UINT64_C(0xFFFFFFFF), UINT64_C(0x100000001)));
    assert_equal_wide(wide(UINT64_MAX - 1U, 1), wide_multiply(UINT64_MAX, UINT64_MAX));
    assert_equal_wide(wide(UINT64_C(0x121FA00AD77D7422), UINT64_C(0x236D88FE5618CF00)),
                      wide_multiply(UINT64_C(0x123456789ABCDEF0), UINT64_C(0xFEDCBA9876543210)));
    assert_equal_wide(wide(0x2FD0, UINT64_C(0x3576F6B688000000)),
                      wide_multiply(2 * UINT64_C(84000000) * UINT64_C(84000000), 16000000));
}

void test_a_product_does_not_depend_on_the_order(void)
{
    for (unsigned i = 0; i < LENGTH(edges); i++) {
        for (unsigned j = 0; j < LENGTH(edges); j++) {
            assert_equal_wide(wide_multiply(edges[i], edges[j]), wide_multiply(edges[j], edges[i]));
        }
    }
}

void test_a_product_with_0_is_0_and_with_1_the_number(void)
{
    for (unsigned i = 0; i < LENGTH(edges); i++) {
        assert_equal_wide(wide(0, 0), wide_multiply(edges[i], 0));
        assert_equal_wide(wide(0, edges[i]), wide_multiply(edges[i], 1));
    }
}

void test_products_distribute_over_sums(void)
{
    for (unsigned i = 0; i < LENGTH(edges); i++) {
        for (unsigned j = 0; j < LENGTH(edges); j++) {
            struct wide less = wide_multiply(edges[i], edges[j] / 2U);
            struct wide more = wide_multiply(edges[i], edges[j] - edges[j] / 2U);
            assert_equal_wide(wide_multiply(edges[i], edges[j]), wide_add(less, more));
        }
    }
}

void test_a_sum_carries_into_the_high_word(void)
{
    assert_equal_wide(wide(3, 7), wide_add(wide(1, 3), wide(2, 4)));
    assert_equal_wide(wide(1, 0), wide_add(wide(0, UINT64_MAX), wide(0, 1)));
    assert_equal_wide(wide(1, UINT64_MAX - 1U), wide_add(wide(0, UINT64_MAX), wide(0, UINT64_MAX)));
}

void test_a_sum_wraps_at_2_to_the_128(void)
{
    assert_equal_wide(wide(0, 0), wide_add(wide(UINT64_MAX, UINT64_MAX), wide(0, 1)));
}

void test_a_difference_borrows_from_the_high_word(void)
{
    assert_equal_wide(wide(2, 4), wide_subtract(wide(3, 7), wide(1, 3)));
    assert_equal_wide(wide(0, UINT64_MAX), wide_subtract(wide(1, 0), wide(0, 1)));
    assert_equal_wide(wide(0, 0), wide_subtract(wide(5, 5), wide(5, 5)));
}

void test_a_difference_wraps_below_0(void)
{
    assert_equal_wide(wide(UINT64_MAX, UINT64_MAX), wide_subtract(wide(0, 0), wide(0, 1)));
}

void test_a_difference_undoes_a_sum(void)
{
    for (unsigned i = 0; i < LENGTH(edges); i++) {
        for (unsigned j = 0; j < LENGTH(edges); j++) {
            struct wide a = wide(edges[i], edges[j]);
            struct wide b = wide(edges[j], edges[i]);
            assert_equal_wide(a, wide_subtract(wide_add(a, b), b));
        }
    }
}

void test_a_shift_by_0_changes_nothing(void)
{
    assert_equal_wide(wide(UINT64_MAX, 1), wide_shift_left(wide(UINT64_MAX, 1), 0));
}

void test_a_shift_moves_bits_into_the_high_word(void)
{
    assert_equal_wide(wide(1, 0), wide_shift_left(wide(0, UINT64_C(0x8000000000000000)), 1));
    assert_equal_wide(wide(UINT64_MAX >> 1U, UINT64_C(0x8000000000000000)), wide_shift_left(wide(0, UINT64_MAX), 63));
    assert_equal_wide(wide(UINT64_C(0x2345678900000000), 0), wide_shift_left(wide(0x123456789U, 0), 32));
}

void test_a_shift_multiplies_by_a_power_of_two(void)
{
    for (unsigned i = 0; i < LENGTH(edges); i++) {
        for (unsigned bits = 0; bits < 64; bits++) {
            assert_equal_wide(wide_multiply(edges[i], UINT64_C(1) << bits), wide_shift_left(wide(0, edges[i]), bits));
        }
    }
}

void test_the_high_word_decides_a_comparison(void)
{
    TEST_ASSERT_TRUE(wide_is_at_least(wide(2, 0), wide(1, UINT64_MAX)));
    TEST_ASSERT_FALSE(wide_is_at_least(wide(1, UINT64_MAX), wide(2, 0)));
}

void test_equal_high_words_leave_it_to_the_low_ones(void)
{
    TEST_ASSERT_TRUE(wide_is_at_least(wide(1, 6), wide(1, 5)));
    TEST_ASSERT_TRUE(wide_is_at_least(wide(1, 5), wide(1, 5)));
    TEST_ASSERT_FALSE(wide_is_at_least(wide(1, 4), wide(1, 5)));
}

static void assert_division(struct wide value, uint64_t divisor, uint64_t quotient, uint64_t remainder)
{
    uint64_t rest = 0;
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(quotient, wide_divide(value, divisor, &rest), "quotient");
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(remainder, rest, "remainder");
}

void test_quotients_are_rounded_down(void)
{
    assert_division(wide(0, 0), 7, 0, 0);
    assert_division(wide(0, 20), 7, 2, 6);
    assert_division(wide(0, 21), 7, 3, 0);
    assert_division(wide(0, UINT64_MAX), 1, UINT64_MAX, 0);
    assert_division(wide(5, 7), UINT64_C(1000000000000000009), 0x5C, UINT64_C(0x33E576FD80FFCCB));
}

void test_the_largest_divisors_divide(void)
{
    const uint64_t largest = UINT64_C(0x8000000000000000);
    assert_division(wide(largest - 1U, UINT64_MAX), largest, UINT64_MAX, largest - 1U);
    assert_division(wide(UINT64_C(0x4000000000000000), 12345), largest - 1U, largest + 1U, 0x303A);
    assert_division(wide(0, largest - 1U), largest, 0, largest - 1U);
    assert_division(wide(0, largest), largest, 1, 0);
}

void test_a_digit_that_is_first_taken_2_too_large_is_put_right(void)
{
    struct wide value = wide(UINT64_C(0x7ED4D57B1E2FEB89), UINT64_C(0xC2CE6F4400000000));
    assert_division(value, UINT64_C(0x80000002FFFFFFFF), UINT64_C(18278328511676929395), UINT64_C(7009459037173831027));
}

void test_the_largest_quotient_fits(void)
{
    assert_division(wide(2, UINT64_MAX), 3, UINT64_MAX, 2);
}

void test_a_quotient_that_does_not_fit_is_told(void)
{
    assert_division(wide(3, 0), 3, UINT64_MAX, 0);
    assert_division(wide(1, 0), 1, UINT64_MAX, 0);
    assert_division(wide(UINT64_MAX, UINT64_MAX), UINT64_C(0x8000000000000000), UINT64_MAX, 0);
}

void test_quotient_and_remainder_give_the_value_back(void)
{
    for (unsigned i = 0; i < LENGTH(edges); i++) {
        for (unsigned j = 0; j < LENGTH(edges); j++) {
            uint64_t divisor = edges[j] > INT64_MAX ? INT64_MAX : edges[j] == 0 ? 10 : edges[j];
            struct wide value = wide(edges[i] % divisor, edges[LENGTH(edges) - 1U - i]);
            uint64_t rest = 0;
            uint64_t quotient = wide_divide(value, divisor, &rest);
            TEST_ASSERT_TRUE(rest < divisor);
            assert_equal_wide(value, wide_add(wide_multiply(quotient, divisor), wide(0, rest)));
        }
    }
}

void test_nearest_quotients_are_rounded_up_from_the_half(void)
{
    TEST_ASSERT_EQUAL_UINT64(2, wide_divide_nearest(wide(0, 24), 10));
    TEST_ASSERT_EQUAL_UINT64(3, wide_divide_nearest(wide(0, 25), 10));
    TEST_ASSERT_EQUAL_UINT64(2, wide_divide_nearest(wide(0, 17), 7));
    TEST_ASSERT_EQUAL_UINT64(3, wide_divide_nearest(wide(0, 18), 7));
    TEST_ASSERT_EQUAL_UINT64(1, wide_divide_nearest(wide(0, 1), 2));
    TEST_ASSERT_EQUAL_UINT64(9, wide_divide_nearest(wide(0, 9), 1));
    TEST_ASSERT_EQUAL_UINT64(0, wide_divide_nearest(wide(0, 0), 1));
}

void test_the_nearest_quotient_of_the_largest_divisor_turns_at_its_half(void)
{
    const uint64_t largest = UINT64_C(0x8000000000000000);
    TEST_ASSERT_EQUAL_UINT64(4, wide_divide_nearest(wide(2, largest / 2U - 1U), largest));
    TEST_ASSERT_EQUAL_UINT64(5, wide_divide_nearest(wide(2, largest / 2U), largest));
}

void test_a_nearest_quotient_that_does_not_fit_is_told(void)
{
    TEST_ASSERT_EQUAL_HEX64(UINT64_MAX, wide_divide_nearest(wide(3, 0), 3));
}

void test_small_roots_are_rounded_to_the_nearest(void)
{
    const uint64_t roots[] = {0, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5};
    for (unsigned i = 0; i < LENGTH(roots); i++) {
        TEST_ASSERT_EQUAL_UINT64(roots[i], wide_root_nearest(wide(0, i)));
    }
}

static const uint64_t sides[] = {
    2,
    3,
    1000,
    UINT32_MAX,
    UINT64_C(0x100000000),
    UINT64_C(0x1FFFFFFFFFFFFFFF),
    UINT64_C(0x2000000000000000),
    UINT64_C(0x3FFFFFFFFFFFFFFF),
};

void test_the_root_of_a_square_and_of_its_neighbours_is_its_side(void)
{
    for (unsigned i = 0; i < LENGTH(sides); i++) {
        struct wide square = wide_multiply(sides[i], sides[i]);
        TEST_ASSERT_EQUAL_HEX64(sides[i], wide_root_nearest(square));
        TEST_ASSERT_EQUAL_HEX64(sides[i], wide_root_nearest(wide_subtract(square, wide(0, 1))));
        TEST_ASSERT_EQUAL_HEX64(sides[i], wide_root_nearest(wide_add(square, wide(0, 1))));
    }
}

/* (side + 1/2)^2 = side^2 + side + 1/4. */
void test_a_root_turns_at_the_half(void)
{
    for (unsigned i = 0; i < LENGTH(sides); i++) {
        struct wide below = wide_add(wide_multiply(sides[i], sides[i]), wide(0, sides[i]));
        TEST_ASSERT_EQUAL_HEX64(sides[i], wide_root_nearest(below));
        TEST_ASSERT_EQUAL_HEX64(sides[i] + 1U, wide_root_nearest(wide_add(below, wide(0, 1))));
    }
}

void test_roots_are_exact_up_to_2_to_the_124(void)
{
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0x4000000000000000), wide_root_nearest(wide(UINT64_MAX >> 4U, UINT64_MAX)));
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(1000000000000000000),
                             wide_root_nearest(wide(UINT64_C(0xC097CE7BC90715), UINT64_C(0xB34B9F1000000000))));
}

void test_scaling_rounds_to_the_nearest(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, wide_scale(1, UINT32_C(0x7FFFFFFF)));
    TEST_ASSERT_EQUAL_UINT64(1, wide_scale(1, UINT32_C(0x80000000)));
    TEST_ASSERT_EQUAL_UINT64(2, wide_scale(3, UINT32_C(0x80000000)));
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0xFFFFFFFEFFFFFFFF), wide_scale(UINT64_MAX, UINT32_MAX));
}

/* 2 * f^2 * 16 000 000 * 60 000: a whole ramp at the steepest acceleration. */
void test_the_root_of_a_ramp_is_exact(void)
{
    struct wide ramp = wide(0x2BC63EF2, UINT64_C(0xCA1F5CC300000000));
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(116393814268629), wide_root_nearest(ramp));
}
