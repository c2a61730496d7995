#include "base_tick.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

void test_a_millisecond_and_a_microsecond_are_whole_numbers_of_ticks(void)
{
    TEST_ASSERT_EQUAL_UINT32(84000, TICKS_PER_MS);
    TEST_ASSERT_EQUAL_UINT32(84, TICKS_PER_US);
    TEST_ASSERT_EQUAL_UINT32(TICK_HZ, TICKS_PER_US * 1000000U);
}

void test_the_difference_is_the_way_from_the_second_to_the_first(void)
{
    TEST_ASSERT_EQUAL_INT32(7, tick_difference(107, 100));
    TEST_ASSERT_EQUAL_INT32(-7, tick_difference(100, 107));
    TEST_ASSERT_EQUAL_INT32(0, tick_difference(100, 100));
}

void test_the_difference_goes_across_the_wrap(void)
{
    TEST_ASSERT_EQUAL_INT32(1, tick_difference(0, UINT32_MAX));
    TEST_ASSERT_EQUAL_INT32(-1, tick_difference(UINT32_MAX, 0));
    TEST_ASSERT_EQUAL_INT32(16, tick_difference(5, UINT32_MAX - 10U));
}

void test_the_longest_ways_keep_their_sign(void)
{
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, tick_difference(0x7FFFFFFFU, 0));
    TEST_ASSERT_EQUAL_INT32(-INT32_MAX, tick_difference(0, 0x7FFFFFFFU));
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, tick_difference(0x7FFFFFFEU, UINT32_MAX));
    TEST_ASSERT_EQUAL_INT32(-INT32_MAX, tick_difference(0x80000002U, 1));
}

void test_a_tick_is_before_later_ones_only(void)
{
    TEST_ASSERT_TRUE(tick_is_before(99, 100));
    TEST_ASSERT_FALSE(tick_is_before(100, 100));
    TEST_ASSERT_FALSE(tick_is_before(101, 100));
}

void test_a_tick_is_before_one_after_the_wrap(void)
{
    TEST_ASSERT_TRUE(tick_is_before(UINT32_MAX, 0));
    TEST_ASSERT_FALSE(tick_is_before(0, UINT32_MAX));
}

void test_before_holds_for_25_seconds(void)
{
    uint32_t longest = 25U * TICK_HZ;
    TEST_ASSERT_TRUE(tick_is_before(1000, 1000U + longest));
    TEST_ASSERT_FALSE(tick_is_before(1000U + longest, 1000));
}

void test_a_tick_is_extended_with_the_high_half_of_the_time_near_it(void)
{
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0x500000010), tick_extend(0x10, UINT64_C(0x500000020)));
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0x500000030), tick_extend(0x30, UINT64_C(0x500000020)));
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0x500000020), tick_extend(0x20, UINT64_C(0x500000020)));
}

void test_a_tick_after_the_wrap_is_extended_into_the_next_round(void)
{
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0x600000003), tick_extend(3, UINT64_C(0x5FFFFFFF0)));
}

void test_a_tick_ahead_of_the_wrap_is_extended_into_the_last_round(void)
{
    TEST_ASSERT_EQUAL_HEX64(UINT64_C(0x5FFFFFFF0), tick_extend(0xFFFFFFF0U, UINT64_C(0x600000003)));
}

void test_extending_finds_every_time_within_25_seconds(void)
{
    const uint64_t near_ticks = UINT64_C(0x1234FFFF0000);
    const int64_t ways[] = {-25 * INT64_C(84000000), -65536, -1, 0, 1, 65535, 65536, 25 * INT64_C(84000000)};
    for (unsigned i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        uint64_t time = near_ticks + (uint64_t)ways[i];
        TEST_ASSERT_EQUAL_HEX64(time, tick_extend((uint32_t)time, near_ticks));
    }
}
