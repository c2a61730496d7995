#include "path_digit.h"
#include "path_divide.h"
#include "path_root.h"
#include "path_wide.h"
#include "unity.h"

enum {
    DRAWS = 100000
};

static uint64_t seed;

void setUp(void)
{
    seed = 1;
}

void tearDown(void)
{
}

static uint64_t draw(void)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return seed ^ (seed >> 29U);
}

/* Of any size, with long rows of 0 and 1. */
static uint64_t draw_odd(void)
{
    uint64_t value = draw();
    unsigned shift = (unsigned)(draw() >> 58U);
    switch (draw() >> 61U) {
    case 0:
        return value >> shift;
    case 1:
        return UINT64_MAX << shift;
    case 2:
        return (UINT64_C(1) << shift) + (draw() >> 62U) - 1U;
    case 3:
        return ~(value >> shift);
    case 4:
        return value | UINT32_MAX;
    default:
        return value;
    }
}

static uint64_t draw_divisor(void)
{
    uint64_t divisor = draw_odd();
    return divisor != 0 ? divisor : 1U;
}

/* quotient * divisor + rest = value, and the rest is less than the divisor. */
static void assert_quotient(struct wide value, uint64_t divisor, uint64_t quotient, uint64_t rest)
{
    struct wide back = wide_add(wide_multiply(quotient, divisor), (struct wide){.low = rest});
    TEST_ASSERT_TRUE(rest < divisor);
    TEST_ASSERT_EQUAL_UINT64(value.high, back.high);
    TEST_ASSERT_EQUAL_UINT64(value.low, back.low);
}

static uint64_t divide(struct wide value, uint64_t divisor, uint64_t *rest)
{
    const struct path_divisor ready = path_divisor_of(divisor);
    return path_divide(value, &ready, rest);
}

static void assert_divides(struct wide value, uint64_t divisor)
{
    uint64_t rest = 0;
    uint64_t quotient = divide(value, divisor, &rest);
    assert_quotient(value, divisor, quotient, rest);
}

void test_quotient_and_rest_give_the_value_back(void)
{
    for (unsigned i = 0; i < DRAWS; i++) {
        uint64_t divisor = draw_divisor();
        assert_divides((struct wide){.high = draw_odd() % divisor, .low = draw_odd()}, divisor);
        assert_divides((struct wide){.high = divisor - 1U, .low = draw_odd()}, divisor);
    }
}

void test_a_fixed_point_quotient_goes_on_after_the_whole_one(void)
{
    for (unsigned i = 0; i < DRAWS; i++) {
        uint64_t rest = 0;
        const struct path_divisor divisor = path_divisor_of(draw_divisor());
        uint64_t size = divisor.scaled >> divisor.shift;
        const struct wide value = {.high = draw_odd() % size, .low = draw_odd()};
        struct wide fixed = path_divide_fixed(value, &divisor);
        TEST_ASSERT_EQUAL_UINT64(path_divide(value, &divisor, &rest), fixed.high);
        TEST_ASSERT_EQUAL_UINT64(path_divide((struct wide){.high = rest}, &divisor, &rest), fixed.low);
    }
}

void test_a_quotient_of_two_words_is_that_of_both(void)
{
    for (unsigned i = 0; i < DRAWS; i++) {
        uint64_t rest = 0;
        const struct path_divisor divisor = path_divisor_of(draw_divisor());
        uint64_t size = divisor.scaled >> divisor.shift;
        const struct wide value = {.high = draw_odd(), .low = draw_odd()};
        struct wide quotient = path_divide_wide(value, &divisor);
        TEST_ASSERT_EQUAL_UINT64(value.high / size, quotient.high);
        const struct wide left = {.high = value.high % size, .low = value.low};
        TEST_ASSERT_EQUAL_UINT64(path_divide(left, &divisor, &rest), quotient.low);
    }
}

void test_the_ends_of_the_range_divide(void)
{
    uint64_t rest = 0;
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, divide((struct wide){.low = UINT64_MAX}, 1, &rest));
    TEST_ASSERT_EQUAL_UINT64(0, rest);
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, divide((struct wide){UINT64_MAX - 1U, UINT64_MAX}, UINT64_MAX, &rest));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX - 1U, rest);
    TEST_ASSERT_EQUAL_UINT64(0, divide((struct wide){0}, UINT64_MAX, &rest));
}

void test_a_digit_is_put_right_by_one_or_two(void)
{
    for (unsigned i = 0; i < DRAWS; i++) {
        uint32_t divisor = (uint32_t)draw_odd() | UINT32_C(1) << 31;
        uint32_t rest = (uint32_t)draw_odd() % divisor;
        uint32_t next = (uint32_t)draw_odd();
        uint64_t value = (uint64_t)rest << 32U | next;
        uint32_t digit = path_digit_pair(&rest, next, divisor);
        TEST_ASSERT_EQUAL_UINT32(value / divisor, digit);
        TEST_ASSERT_EQUAL_UINT32(value % divisor, rest);
    }
}

static void assert_root(struct wide value)
{
    TEST_ASSERT_EQUAL_UINT64(wide_root_nearest(value), path_root(value));
}

void test_roots_are_those_of_the_other_way(void)
{
    for (unsigned i = 0; i < DRAWS; i++) {
        assert_root((struct wide){.high = draw_odd() >> 4U, .low = draw_odd()});
        assert_root((struct wide){.low = draw_odd()});
    }
    assert_root((struct wide){0});
    assert_root((struct wide){.high = UINT64_MAX >> 4U, .low = UINT64_MAX});
}

void test_the_root_of_a_square_and_of_its_neighbours_is_its_side(void)
{
    for (unsigned i = 0; i < DRAWS; i++) {
        uint64_t side = (draw_odd() >> 1U) | 2U;
        struct wide square = wide_multiply(side, side);
        TEST_ASSERT_EQUAL_UINT64(side, path_root(square));
        TEST_ASSERT_EQUAL_UINT64(side, path_root(wide_subtract(square, (struct wide){.low = 1})));
        TEST_ASSERT_EQUAL_UINT64(side, path_root(wide_add(square, (struct wide){.low = side})));
        TEST_ASSERT_EQUAL_UINT64(side + 1U, path_root(wide_add(square, (struct wide){.low = side + 1U})));
    }
}

void test_wide_arithmetic_is_that_of_the_base(void)
{
    for (unsigned i = 0; i < DRAWS; i++) {
        const struct wide a = {.high = draw_odd(), .low = draw_odd()};
        const struct wide b = {.high = (draw() & 1U) != 0 ? a.high : draw_odd(), .low = draw_odd()};
        unsigned bits = (unsigned)(draw() >> 58U);
        TEST_ASSERT_TRUE(path_wide_is_equal(wide_multiply(a.high, a.low), path_wide_multiply(a.high, a.low)));
        TEST_ASSERT_TRUE(path_wide_is_equal(wide_add(a, b), path_wide_add(a, b)));
        TEST_ASSERT_TRUE(path_wide_is_equal(wide_subtract(a, b), path_wide_subtract(a, b)));
        TEST_ASSERT_TRUE(path_wide_is_equal(wide_shift_left(a, bits), path_wide_shift(a, bits)));
        TEST_ASSERT_EQUAL(wide_is_at_least(a, b), path_wide_is_at_least(a, b));
        TEST_ASSERT_FALSE(path_wide_is_equal(a, wide_add(a, (struct wide){.high = 1})));
        TEST_ASSERT_FALSE(path_wide_is_equal(a, wide_add(a, (struct wide){.low = 1})));
    }
}

/* For this divisor the rest that is left is as large as its upper half. */
void test_the_reciprocal_of_a_divisor_is_rounded_down(void)
{
    const struct path_divisor divisor = path_divisor_of(UINT64_C(0x9132D8FAC07B072A));
    TEST_ASSERT_EQUAL_HEX32(UINT32_C(0xC35AA905), divisor.reciprocal);
}

void test_the_last_binary_place_of_a_quotient_is_rounded_down(void)
{
    const struct path_divisor divisor = path_divisor_of(UINT64_MAX);
    struct wide quotient = path_divide_fixed((struct wide){.low = UINT64_MAX - 1U}, &divisor);
    TEST_ASSERT_EQUAL_UINT64(0, quotient.high);
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX - 1U, quotient.low);
}
