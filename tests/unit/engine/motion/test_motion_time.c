#include "motion_time.h"
#include "step_scale.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static struct wide small(uint64_t value)
{
    return (struct wide){.low = value};
}

static void assert_time(uint64_t ticks, uint32_t fraction, struct motion_time time)
{
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(ticks, time.ticks, "ticks");
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(fraction, time.fraction, "fraction");
}

static void assert_place(uint64_t step, uint64_t quanta, struct motion_place place)
{
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(step, place.step, "step");
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(quanta, place.quanta, "quanta");
}

void test_whole_ticks_are_added(void)
{
    assert_time(107, 5, motion_time_add((struct motion_time){100, 5}, small(21), 3));
}

void test_parts_of_a_tick_are_kept(void)
{
    assert_time(102, UINT32_C(0x80000000), motion_time_add((struct motion_time){100, 0}, small(5), 2));
}

void test_parts_below_the_fraction_are_dropped(void)
{
    assert_time(0, UINT32_C(0x55555555), motion_time_add((struct motion_time){0, 0}, small(1), 3));
    assert_time(0, UINT32_C(0xAAAAAAAA), motion_time_add((struct motion_time){0, 0}, small(2), 3));
}

void test_fractions_carry_into_the_ticks(void)
{
    const struct motion_time time = {100, UINT32_C(0x80000000)};

    assert_time(101, 0, motion_time_add(time, small(1), 2));
    assert_time(101, UINT32_C(0x40000000), motion_time_add(time, small(3), 4));
}

void test_a_quotient_of_128_bits_by_the_largest_divisor_is_added(void)
{
    const struct wide dividend = {.high = UINT64_C(1) << 62, .low = UINT64_C(1) << 62};

    assert_time((UINT64_C(1) << 63) + 1U, UINT32_C(0x80000000),
                motion_time_add((struct motion_time){1, 0}, dividend, UINT64_C(1) << 63));
}

void test_the_whole_tick_at_or_after_a_time(void)
{
    TEST_ASSERT_EQUAL_UINT64(7, motion_time_up((struct motion_time){7, 0}));
    TEST_ASSERT_EQUAL_UINT64(8, motion_time_up((struct motion_time){7, 1}));
    TEST_ASSERT_EQUAL_UINT64(8, motion_time_up((struct motion_time){7, UINT32_MAX}));
}

void test_the_way_between_places_is_in_quanta(void)
{
    const struct motion_place a = {.step = 3, .quanta = STEP_QUANTA - 1U};
    const struct motion_place b = {.step = 5, .quanta = 1};

    struct wide distance = motion_place_distance(a, b);

    TEST_ASSERT_EQUAL_HEX64(STEP_QUANTA + 2U, distance.low);
    TEST_ASSERT_EQUAL_HEX64(0, distance.high);
}

void test_the_longest_way_needs_more_than_64_bits_and_has_them(void)
{
    const struct motion_place end = {.step = UINT64_C(1) << 44};

    struct wide distance = motion_place_distance((struct motion_place){0}, end);

    TEST_ASSERT_EQUAL_HEX64(STEP_QUANTA >> 20U, distance.high);
    TEST_ASSERT_EQUAL_HEX64(STEP_QUANTA << 44U, distance.low);
}

void test_the_way_from_a_place_to_itself_is_nothing(void)
{
    const struct motion_place place = {.step = 9, .quanta = 99};

    struct wide distance = motion_place_distance(place, place);

    TEST_ASSERT_EQUAL_HEX64(0, distance.low);
    TEST_ASSERT_EQUAL_HEX64(0, distance.high);
}

void test_steps_and_parts_of_a_step_are_added_to_a_place(void)
{
    assert_place(12, 0, motion_place_add(10, 8, 4));
    assert_place(12, STEP_QUANTA / 4U, motion_place_add(10, 9, 4));
    assert_place(12, STEP_QUANTA / 4U * 3U, motion_place_add(10, 11, 4));
}

void test_parts_of_a_step_are_rounded_to_the_nearest_quantum(void)
{
    const uint64_t part = STEP_QUANTA / 11U;
    TEST_ASSERT_NOT_EQUAL_UINT64(0, STEP_QUANTA % 11U);

    assert_place(0, part + (2U * (STEP_QUANTA % 11U) > 11U ? 1U : 0U), motion_place_add(0, 1, 11));
}

void test_steps_and_parts_of_a_step_are_taken_off_a_place(void)
{
    assert_place(8, 0, motion_place_subtract(10, 8, 4));
    assert_place(7, STEP_QUANTA / 4U * 3U, motion_place_subtract(10, 9, 4));
    assert_place(7, STEP_QUANTA / 4U, motion_place_subtract(10, 11, 4));
}

void test_nothing_taken_off_leaves_the_place(void)
{
    assert_place(10, 0, motion_place_subtract(10, 0, 4));
}

void test_a_place_can_be_taken_back_to_0(void)
{
    assert_place(0, 0, motion_place_subtract(10, 40, 4));
    assert_place(0, STEP_QUANTA / 4U, motion_place_subtract(10, 39, 4));
}
