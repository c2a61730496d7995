#include "path_fixed.h"
#include "path_vector.h"
#include "step_scale.h"
#include "unity.h"

static void assert_fixed(uint64_t high, uint64_t low, struct wide value)
{
    TEST_ASSERT_EQUAL_UINT64(high, value.high);
    TEST_ASSERT_EQUAL_UINT64(low, value.low);
}

void setUp(void)
{
}

void tearDown(void)
{
}

void test_a_wide_number_is_multiplied_with_its_carry(void)
{
    assert_fixed(23, UINT64_MAX - 2U, path_wide_times((struct wide){.high = 7, .low = UINT64_MAX}, 3));
}

void test_a_quotient_has_64_binary_places(void)
{
    assert_fixed(3, UINT64_MAX / 3U, path_fixed_divide((struct wide){.low = 10}, 3));
    assert_fixed(UINT64_C(1) << 63, UINT64_C(1) << 63, path_fixed_divide((struct wide){.high = 1, .low = 1}, 2));
}

void test_a_product_has_the_parts_of_both_factors(void)
{
    const struct wide two_and_a_half = {.high = 2, .low = UINT64_C(1) << 63};
    assert_fixed(6, UINT64_C(1) << 62, path_fixed_multiply(two_and_a_half, two_and_a_half));
    assert_fixed(7, UINT64_C(1) << 63, path_fixed_multiply((struct wide){.high = 3}, two_and_a_half));
}

void test_a_product_that_is_too_large_is_never(void)
{
    assert_fixed(
        PATH_FIXED_NEVER, 0,
        path_fixed_multiply((struct wide){.high = UINT64_C(1) << 34}, (struct wide){.high = UINT64_C(1) << 30}));
    assert_fixed(
        PATH_FIXED_NEVER, 0,
        path_fixed_multiply((struct wide){.high = UINT64_C(1) << 33}, (struct wide){.high = UINT64_C(3) << 29}));
    assert_fixed(
        UINT64_C(1) << 62, 0,
        path_fixed_multiply((struct wide){.high = UINT64_C(1) << 32}, (struct wide){.high = UINT64_C(1) << 30}));
}

void test_the_slope_of_a_whole_speed_is_exact(void)
{
    const uint32_t speeds[] = {1, 2, 3, 2560, 256 * 16000, 256 * 200000, PATH_SPEED_MAX};
    for (unsigned i = 0; i < sizeof speeds / sizeof speeds[0]; i++) {
        uint64_t square = (uint64_t)speeds[i] * speeds[i];
        assert_fixed((uint64_t)speeds[i] * TICK_HZ, 0, path_fixed_slope(2U * square));
    }
    assert_fixed(0, 0, path_fixed_slope(0));
}

void test_the_slope_of_an_irrational_speed_has_64_binary_places(void)
{
    /* f * sqrt(h/2) with 128 binary places, cut off after 64. */
    const struct {
        uint64_t twice_speed2;
        struct wide slope;
    } known[] = {
        {1, {UINT64_C(59396969), UINT64_C(0x9EA2B14E2A79833F)}},
        {3, {UINT64_C(102878569), UINT64_C(0x32679C71EDEF647A)}},
        {393216, {UINT64_C(37246020565), UINT64_C(0xF60D186C6D14FE25)}},
        {UINT64_C(209715199999999), {UINT64_C(860159999999997), UINT64_C(0xF2FFFFFFFFFF4FD6)}},
    };
    for (unsigned i = 0; i < sizeof known / sizeof known[0]; i++) {
        struct wide slope = path_fixed_slope(known[i].twice_speed2);
        TEST_ASSERT_EQUAL_UINT64(known[i].slope.high, slope.high);
        TEST_ASSERT_UINT64_WITHIN(8, known[i].slope.low, slope.low);
    }
}

void test_the_pace_is_the_time_of_a_step(void)
{
    assert_fixed(TICK_HZ, 0, path_fixed_pace(path_fixed_slope(UINT64_C(2) * 256U * 256U)));
    assert_fixed(420, 0, path_fixed_pace((struct wide){.high = 200000U * STEP_SLOPE_PER_SPEED}));
    assert_fixed(UINT64_C(256) * TICK_HZ, 0, path_fixed_pace((struct wide){.high = TICK_HZ}));
}

void test_a_product_of_2_to_the_62_is_not_too_large_yet(void)
{
    const struct wide factor = {.high = UINT64_C(1) << 30, .low = UINT64_C(1) << 63};
    assert_fixed((UINT64_C(1) << 62) + (UINT64_C(1) << 31), 0,
                 path_fixed_multiply((struct wide){.high = UINT64_C(1) << 32}, factor));
}

void test_the_last_binary_place_of_a_factor_counts(void)
{
    assert_fixed(5, 5, path_fixed_multiply((struct wide){.high = 1, .low = 1}, (struct wide){.high = 5}));
}

static uint64_t draw(uint64_t *seed, unsigned bits)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (*seed ^ *seed >> 29U) >> (64U - bits);
}

/* The slope s + f of a square s^2 + r: f is r/2s less f^2/2s. */
static void assert_slope(uint64_t twice_speed2)
{
    struct wide square = path_wide_multiply(PATH_SLOPE2_PER_TWICE_SPEED2, twice_speed2);
    struct wide slope = path_fixed_slope(twice_speed2);
    struct wide rest = path_wide_subtract(square, path_wide_multiply(slope.high, slope.high));
    TEST_ASSERT_EQUAL_UINT64(0, rest.high);
    struct wide first = path_fixed_divide((struct wide){.low = rest.low}, 2U * slope.high);
    uint64_t second =
        path_fixed_divide((struct wide){.low = path_wide_multiply(first.low, first.low).high}, 2U * slope.high).high;
    TEST_ASSERT_EQUAL_UINT64(0, first.high);
    TEST_ASSERT_UINT64_WITHIN(16, first.low - second, slope.low);
}

void test_slopes_of_all_sizes_are_2_to_the_minus_60_off_at_most(void)
{
    uint64_t seed = 1;
    for (unsigned bits = 13; bits <= 56; bits++) {
        for (unsigned i = 0; i < 1000; i++) {
            uint64_t twice_speed2 = draw(&seed, bits) | UINT64_C(1) << (bits - 1U);
            if (twice_speed2 <= 2U * (uint64_t)PATH_SPEED_MAX * PATH_SPEED_MAX) {
                assert_slope(twice_speed2);
            }
        }
    }
}

/* The product of both is a step: too much by 2^-62 of it at most, and too little by the last place of the pace. */
void test_paces_of_all_sizes_are_2_to_the_minus_62_of_them_off_at_most(void)
{
    const struct wide step = {.high = STEP_QUANTA};
    const struct wide most = {.high = STEP_QUANTA, .low = STEP_QUANTA << 2U};
    uint64_t seed = 1;
    for (unsigned bits = 21; bits <= 56; bits++) {
        for (unsigned i = 0; i < 1000; i++) {
            struct wide slope = {.high = draw(&seed, bits) | UINT64_C(1) << (bits - 1U), .low = draw(&seed, 64)};
            slope.high &= ~(i % 2U != 0 ? UINT64_C(0xFF) << (bits - 9U) : 0U);
            struct wide product = path_fixed_multiply(path_fixed_pace(slope), slope);
            TEST_ASSERT_TRUE(path_wide_is_at_least(most, product));
            product = path_wide_add(product, (struct wide){.low = slope.high + 4U});
            TEST_ASSERT_TRUE(path_wide_is_at_least(product, step));
        }
    }
}
