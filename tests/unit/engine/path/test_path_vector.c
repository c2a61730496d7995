#include "path_rig.h"
#include "path_vector.h"
#include "unity.h"

static struct path_section taken(const struct path_vector *vector)
{
    struct path_section section;
    path_section_take(&section, vector);
    return section;
}

static struct path_section section_of(int32_t x, int32_t y)
{
    struct path_vector vector = rig_vector(x, y, 1000, 1000);
    return taken(&vector);
}

void setUp(void)
{
}

void tearDown(void)
{
}

void test_the_length_is_that_of_the_longest_axis(void)
{
    struct path_vector vector = {.steps = {-3, 7, INT32_MIN + 1, 9}, .speed = 1, .accel = 1, .extent2 = 1};
    TEST_ASSERT_EQUAL_UINT32(INT32_MAX, taken(&vector).length);
    vector.steps[2] = 0;
    TEST_ASSERT_EQUAL_UINT32(9, taken(&vector).length);
}

void test_where_speeds_count_the_longest_axis_squares_are_the_same_on_both_sides_of_a_border(void)
{
    struct path_section section = section_of(3000, 4000);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(1000) * 256 * 1000 * 256, section.speed2);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(1024) * 128 * 1000 * 4000, section.gain2);
    TEST_ASSERT_EQUAL_UINT64(77, path_section_to_border2(&section, 77));
    TEST_ASSERT_EQUAL_UINT64(77, path_section_from_border2(&section, 77));
}

/* (3000, 4000) is 5000 long: squares times 16/25 and back. */
void test_where_speeds_count_another_length_squares_are_scaled_and_rounded_down(void)
{
    struct path_vector vector = rig_vector(3000, 4000, 1000, 1000);
    vector.extent2 = 25000000;
    struct path_section section = taken(&vector);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(1000) * 256 * 1000 * 256 * 25 / 16, section.speed2);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(1024) * 128 * 1000 * 4000 * 25 / 16, section.gain2);
    TEST_ASSERT_EQUAL_UINT64(101 * 25 / 16, path_section_to_border2(&section, 101));
    TEST_ASSERT_EQUAL_UINT64(101 * 25 / 16 + 1, path_section_to_border2_up(&section, 101));
    TEST_ASSERT_EQUAL_UINT64(25, path_section_to_border2_up(&section, 16));
    TEST_ASSERT_EQUAL_UINT64(101 * 16 / 25, path_section_from_border2(&section, 101));
}

/* E^2 = 3 * (2^31-1)^2, which has 64 bits: a third, rounded down. */
void test_the_longest_diagonal_of_three_axes_can_be_scaled(void)
{
    const uint64_t length2 = (uint64_t)INT32_MAX * INT32_MAX;
    struct path_vector vector = {.steps = {INT32_MAX, -INT32_MAX, INT32_MAX}, .accel = 1, .extent2 = 3U * length2};
    struct path_section section = taken(&vector);
    const uint64_t squares[] = {1, 2, 3, 4, 5, UINT64_C(3) << 52, (UINT64_C(3) << 52) - 1U, (UINT64_C(3) << 52) + 1U};
    for (unsigned i = 0; i < sizeof squares / sizeof squares[0]; i++) {
        TEST_ASSERT_EQUAL_UINT64(squares[i] / 3U, path_section_from_border2(&section, squares[i]));
        TEST_ASSERT_EQUAL_UINT64(3U * squares[i], path_section_to_border2(&section, squares[i]));
    }
}

/* Halves of which would be one too many. */
void test_a_quotient_by_64_bits_is_rounded_down_where_its_halves_are_not(void)
{
    struct path_vector vector = {
        .steps = {INT32_MAX, INT32_MAX, 1}, .accel = 1, .extent2 = UINT64_C(9223372766328310537)};
    struct path_section section = taken(&vector);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(16259766965695289),
                             path_section_from_border2(&section, UINT64_C(32519536533636262)));
}

void test_what_is_more_than_any_speed_stays_countable(void)
{
    struct path_vector vector = {.steps = {1, 0, 0, INT32_MAX}, .accel = PATH_ACCEL_MAX, .extent2 = 1};
    struct path_section section = taken(&vector);
    TEST_ASSERT_EQUAL_UINT64(PATH_SPEED2_ENDLESS, path_section_from_border2(&section, 1));
    vector =
        (struct path_vector){.steps = {INT32_MAX}, .accel = PATH_ACCEL_MAX, .extent2 = (uint64_t)INT32_MAX * INT32_MAX};
    TEST_ASSERT_EQUAL_UINT64(PATH_SPEED2_ENDLESS, taken(&vector).gain2);
}

void test_an_axis_that_turns_has_time_for_it_before_its_first_pulse(void)
{
    struct path_section before = section_of(100, 1);
    struct path_section after = section_of(-50, 100);
    path_section_mind_turns(&after, &before, 12);
    /* 256*10^6 * 100 / (12 * 50) less what 128000/128 * 12 us gain. */
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(42666664) * 42666664, after.border2);
    before = section_of(-100, 1);
    after = section_of(50, 100);
    path_section_mind_turns(&after, &before, 12);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(42666664) * 42666664, after.border2);
}

void test_of_the_axes_that_turn_the_one_with_the_fewest_steps_is_told(void)
{
    struct path_section before = section_of(100, 1);
    struct path_section after = section_of(-50, -7);
    path_section_mind_turns(&after, &before, 12);
    TEST_ASSERT_EQUAL_UINT32(7, after.turning);
    after = section_of(-7, -50);
    path_section_mind_turns(&after, &before, 12);
    TEST_ASSERT_EQUAL_UINT32(7, after.turning);
    after = section_of(7, 50);
    path_section_mind_turns(&after, &before, 12);
    TEST_ASSERT_EQUAL_UINT32(0, after.turning);
}

void test_an_axis_that_goes_on_or_rests_needs_no_time(void)
{
    const int32_t pairs[][2] = {{1, 1}, {-1, -1}, {0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    for (unsigned i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        struct path_section before = section_of(pairs[i][0], 10);
        struct path_section after = section_of(pairs[i][1], 10);
        uint64_t border2 = after.border2;
        path_section_mind_turns(&after, &before, 12);
        TEST_ASSERT_EQUAL_UINT64(border2, after.border2);
    }
}

void test_a_turn_may_need_a_stand_and_may_need_nothing(void)
{
    struct path_section before = section_of(-1, -1);
    struct path_vector fast = rig_vector(1, 1, 1000, STEP_ACCEL_MAX);
    struct path_section after = taken(&fast);
    path_section_mind_turns(&after, &before, PATH_TURN_US_MAX);
    TEST_ASSERT_EQUAL_UINT64(0, after.border2);
    after = section_of(1, INT32_MAX);
    uint64_t border2 = after.border2;
    before = section_of(-1, 1);
    path_section_mind_turns(&after, &before, 12);
    TEST_ASSERT_EQUAL_UINT64(border2, after.border2);
}

void test_a_speed_of_a_short_extent_is_more_than_any_on_a_long_axis(void)
{
    struct path_vector vector = rig_vector(1, INT32_MAX, 1000, 1000);
    vector.extent2 = 1;
    struct path_section section = taken(&vector);
    TEST_ASSERT_EQUAL_UINT64(PATH_SPEED2_ENDLESS, path_section_from_border2(&section, UINT64_C(1) << 52));
}

void test_another_acceleration_is_that_of_a_section_taken_with_it(void)
{
    struct path_vector vector = rig_vector(100, 7, 1000, 1000);
    struct path_section section = taken(&vector);
    path_section_set_accel(&section, 3 * vector.accel);
    vector.accel *= 3U;
    TEST_ASSERT_EQUAL_UINT64(taken(&vector).gain2, section.gain2);
    TEST_ASSERT_EQUAL_UINT32(vector.accel, section.vector.accel);
}

void test_after_another_section_there_is_no_turn_any_more(void)
{
    struct path_section before = section_of(-100, 1);
    struct path_section after = section_of(50, 100);
    after.vector.border_speed = 77;
    path_section_mind_turns(&after, &before, 12);
    before = section_of(100, 1);
    path_section_mind_turns(&after, &before, 12);
    TEST_ASSERT_EQUAL_UINT32(0, after.turning);
    TEST_ASSERT_EQUAL_UINT64(77 * 77, after.border2);
}

/* 1/128 step/s^2 in 1 us: rounded up, one unit of speed. */
void test_what_an_axis_gains_while_it_turns_is_rounded_up(void)
{
    struct path_section before = section_of(-10, 1);
    struct path_vector slow = {.steps = {10}, .speed = 1000, .accel = 1, .extent2 = 100, .border_speed = UINT32_MAX};
    struct path_section after = taken(&slow);
    path_section_mind_turns(&after, &before, 1);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(255999999) * 255999999, after.border2);
}

void test_a_quotient_of_65_bits_is_endless(void)
{
    struct path_vector vector = {.steps = {65536}, .accel = 1, .extent2 = 1};
    struct path_section section = taken(&vector);
    TEST_ASSERT_EQUAL_UINT64(PATH_SPEED2_ENDLESS, path_section_from_border2(&section, UINT64_C(1) << 32));
}
