#include "path_root.h"
#include "path_wide.h"
#include "unity.h"

enum {
    WORD_BITS = 64,
    ROOT_BITS = 63,
    RUNS = 2000
};

static uint64_t seed;

void setUp(void)
{
    seed = 16;
}

void tearDown(void)
{
}

/* Of so many bits, the highest of them set; now and then with all the others set, or none. */
static uint64_t draw(unsigned bits)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    uint64_t top = UINT64_C(1) << (bits - 1U);
    uint64_t value = (seed ^ seed >> 29U) & (top - 1U);
    switch (seed >> 61U) {
    case 0:
        return top | (value & 3U);
    case 1:
        return top | (top - 1U - (value & 3U));
    case 2:
        return top | (value & ~(uint64_t)UINT32_MAX);
    case 3:
        return top | (value & UINT32_MAX);
    default:
        return top | value;
    }
}

/* The nearest root r of a value lies from r^2 - r + 1 to r^2 + r. */
static void assert_root(struct wide value)
{
    uint64_t root = path_root(value);
    struct wide square = path_wide_multiply(root, root);
    struct wide most = path_wide_add(square, (struct wide){.low = root});
    TEST_ASSERT_TRUE(path_wide_is_at_least(most, value));
    if (root != 0) {
        struct wide least = path_wide_subtract(square, (struct wide){.low = root - 1U});
        TEST_ASSERT_TRUE(path_wide_is_at_least(value, least));
    }
}

void test_small_numbers_have_their_nearest_root(void)
{
    for (uint64_t value = 0; value < 100000; value++) {
        assert_root((struct wide){.low = value});
    }
}

void test_numbers_of_every_size_have_their_nearest_root(void)
{
    for (unsigned i = 0; i < RUNS; i++) {
        for (unsigned bits = 1; bits <= WORD_BITS; bits++) {
            assert_root((struct wide){.low = draw(bits)});
        }
        for (unsigned bits = 1; bits < WORD_BITS - 1U; bits++) {
            assert_root((struct wide){.high = draw(bits), .low = draw(WORD_BITS)});
            assert_root((struct wide){.high = draw(bits), .low = draw(1U + i % WORD_BITS)});
        }
    }
}

/* Next to a square, and where the nearest root changes from one to the next. */
void test_squares_and_what_lies_beside_them_and_half_way_have_their_root(void)
{
    for (unsigned i = 0; i < RUNS; i++) {
        for (unsigned bits = 2; bits <= ROOT_BITS; bits++) {
            uint64_t root = draw(bits);
            struct wide square = path_wide_multiply(root, root);
            struct wide half_way = path_wide_add(square, (struct wide){.low = root});
            TEST_ASSERT_EQUAL_UINT64(root, path_root(square));
            TEST_ASSERT_EQUAL_UINT64(root, path_root(path_wide_subtract(square, (struct wide){.low = 1})));
            TEST_ASSERT_EQUAL_UINT64(root, path_root(half_way));
            TEST_ASSERT_EQUAL_UINT64(root + 1U, path_root(path_wide_add(half_way, (struct wide){.low = 1})));
        }
    }
}

/* A root that is one too low leaves a rest of more than 64 bits there. */
void test_the_largest_roots_are_right(void)
{
    for (uint64_t below = 1; below < 1000; below++) {
        uint64_t root = (UINT64_C(1) << ROOT_BITS) - below;
        struct wide square = path_wide_multiply(root, root);
        for (unsigned bits = 1; bits < ROOT_BITS; bits++) {
            struct wide rest = {.low = draw(bits)};
            TEST_ASSERT_EQUAL_UINT64(root, path_root(path_wide_add(square, rest)));
            rest.low = UINT64_C(1) << (bits - 1U);
            TEST_ASSERT_EQUAL_UINT64(root, path_root(path_wide_add(square, rest)));
        }
    }
}
