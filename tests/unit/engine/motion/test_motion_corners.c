#include "motion_corners.h"
#include "unity.h"

static struct motion_plan plan;
static struct motion_corner corners[MOTION_CORNERS_MAX];

static const struct motion_order single = {
    .section = {{5000, 1000, 2000}},
    .start_speed_steps_per_s = 100,
    .sections = 1,
};

/* The ninth example of the manual. */
static const struct motion_order manual = {
    .section = {{2000, 500, 2000},
                {2000, 2000, 2000},
                {5000, 500, 2000},
                {5000, 3000, 1000},
                {2000, 1500, 1000},
                {2000, 500, 1000}},
    .start_speed_steps_per_s = 100,
    .sections = 6,
};

void setUp(void)
{
}

void tearDown(void)
{
}

static void assert_corners(const struct motion_corner *expected, unsigned count)
{
    TEST_ASSERT_EQUAL_UINT(count, motion_corners_of(&plan, corners));
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(expected[i].step, corners[i].step, "step");
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(expected[i].speed_steps_per_s, corners[i].speed_steps_per_s, "speed");
    }
}

static void begin_section(uint32_t start_speed, struct motion_section section)
{
    const struct motion_order order = {
        .section = {section},
        .start_speed_steps_per_s = start_speed,
        .sections = 1,
    };
    motion_plan_begin(&plan, &order, 0);
}

static void begin_single(uint64_t steps, uint32_t start_speed, uint32_t speed, uint32_t accel)
{
    begin_section(start_speed, (struct motion_section){steps, speed, accel});
}

void test_a_trapezoid_has_four_corners(void)
{
    const struct motion_corner expected[] = {{1, 100}, {248, 1000}, {4753, 1000}, {5000, 0}};
    motion_plan_begin(&plan, &single, 0);

    assert_corners(expected, 4);
}

void test_ramps_that_meet_are_one_corner(void)
{
    const struct motion_corner expected[] = {{1, 100}, {50, 458}, {100, 0}};
    begin_single(100, 100, 1000, 2000);

    assert_corners(expected, 3);
}

void test_a_constant_speed_has_only_its_ends(void)
{
    const struct motion_corner expected[] = {{1, 80}, {5000, 0}};
    begin_single(5000, 100, 80, 2000);

    assert_corners(expected, 2);
}

void test_a_corner_in_the_middle_between_steps_is_rounded_up(void)
{
    const struct motion_corner expected[] = {{1, 2}, {1, 2}, {1, 0}};
    begin_single(1, 2, 3, 1);

    assert_corners(expected, 3);
}

/* (102^2 - 100^2) / 10 is 40.4. */
void test_a_corner_before_the_middle_between_steps_is_rounded_down_and_one_after_it_up(void)
{
    const struct motion_corner expected[] = {{1, 100}, {40, 102}, {1000 - 40, 102}, {1000, 0}};
    begin_single(1000, 100, 102, 5);

    assert_corners(expected, 4);
}

/* Ramps that meet at v^2 = S^2 + A: 6.25 is 2.5^2, which is rounded up, and sqrt(6) = 2.45 is not. */
void test_speeds_are_rounded_to_the_nearest(void)
{
    begin_single(1, 2, 16000, 2);
    (void)motion_corners_of(&plan, corners);
    TEST_ASSERT_EQUAL_UINT32(2, corners[1].speed_steps_per_s);

    begin_single(1, 2, 16000, 3);
    (void)motion_corners_of(&plan, corners);
    TEST_ASSERT_EQUAL_UINT32(3, corners[1].speed_steps_per_s);
}

/* The square of a whole number and a half is a quarter off a whole one: 0.6 millionths of a step/s at 200 000. */
void test_high_speeds_are_rounded_to_the_nearest(void)
{
    const uint64_t speed = 200000;
    const struct motion_point below = {.step = 1, .speed2 = speed * speed + speed};
    const struct motion_point above = {.step = 1, .speed2 = speed * speed + speed + 1U};
    begin_single(1000000, 100, 300000, 8000000);
    (void)motion_plan_change_speed(&plan, &below, 300000);
    (void)motion_corners_of(&plan, corners);
    TEST_ASSERT_EQUAL_UINT32(speed, corners[1].speed_steps_per_s);

    (void)motion_plan_change_speed(&plan, &above, 300000);
    (void)motion_corners_of(&plan, corners);
    TEST_ASSERT_EQUAL_UINT32(speed + 1U, corners[1].speed_steps_per_s);
}

void test_the_borders_of_the_manuals_example(void)
{
    const struct motion_corner expected[] = {
        {1, 100},      {60, 500},     {2000, 500},   {2938, 2000}, {3063, 2000}, {4000, 500}, {9000, 500},
        {12000, 2500}, {14000, 1500}, {15000, 1500}, {16000, 500}, {17880, 500}, {18000, 0},
    };
    motion_plan_begin(&plan, &manual, 0);

    assert_corners(expected, 13);
}

void test_the_longest_move_with_an_end_has_all_its_corners(void)
{
    struct motion_order order = {.start_speed_steps_per_s = 100, .sections = MOTION_SECTIONS};
    for (unsigned i = 0; i < MOTION_SECTIONS; i++) {
        order.section[i] = (struct motion_section){MOTION_SECTION_STEPS_MAX, 100, 2000};
    }
    motion_plan_begin(&plan, &order, 0);

    TEST_ASSERT_EQUAL_UINT(1 + MOTION_SECTIONS, motion_corners_of(&plan, corners));

    TEST_ASSERT_EQUAL_UINT64(MOTION_STEPS_MAX, corners[MOTION_SECTIONS].step);
    TEST_ASSERT_EQUAL_UINT32(0, corners[MOTION_SECTIONS].speed_steps_per_s);
}

void test_a_run_without_end_has_no_last_corner(void)
{
    const struct motion_corner expected[] = {{1, 100}, {248, 1000}};
    begin_section(100, motion_order_endless(1000, 2000));

    assert_corners(expected, 2);
}

void test_a_run_without_end_at_the_start_speed_has_one_corner(void)
{
    const struct motion_corner expected[] = {{1, 100}};
    begin_section(100, motion_order_endless(100, 2000));

    assert_corners(expected, 1);
}

/* S would be reached at step 1247.5, after the last pulse. */
void test_a_stop_shows_where_it_began_and_where_it_ends(void)
{
    const struct motion_corner expected[] = {{1, 100}, {1000, 1000}, {1247, 0}};
    const struct motion_point at = {.step = 1000, .speed2 = 1000000};
    motion_plan_begin(&plan, &single, 0);
    TEST_ASSERT_TRUE(motion_plan_stop(&plan, &at));

    assert_corners(expected, 3);
}

/* After most of a year at 400 000 steps/s. */
void test_a_late_stop_of_a_run_without_end_is_shown_too(void)
{
    const uint64_t late = MOTION_STEPS_MAX + 1U;
    const struct motion_corner expected[] = {{1, 100}, {late, 1000}, {late + 247U, 0}};
    const struct motion_point at = {.step = late, .speed2 = 1000000};
    begin_section(100, motion_order_endless(1000, 2000));
    TEST_ASSERT_TRUE(motion_plan_stop(&plan, &at));

    assert_corners(expected, 3);
}

void test_a_stop_at_the_start_speed_ends_where_it_began(void)
{
    const struct motion_corner expected[] = {{1, 100}, {1000, 0}};
    const struct motion_point at = {.step = 1000, .speed2 = 10000};
    begin_single(5000, 100, 100, 2000);
    TEST_ASSERT_TRUE(motion_plan_stop(&plan, &at));

    assert_corners(expected, 2);
}

void test_a_stop_through_two_sections_has_a_corner_at_their_border(void)
{
    const struct motion_corner expected[] = {{1, 100}, {3900, 1900}, {4000, 1792}, {4800, 0}};
    const struct motion_point at = {.step = 3900, .speed2 = 1900 * 1900};
    motion_plan_begin(&plan, &manual, 0);
    TEST_ASSERT_TRUE(motion_plan_stop(&plan, &at));

    assert_corners(expected, 4);
}

void test_a_change_of_speed_shows_where_it_began_and_what_follows(void)
{
    const struct motion_corner expected[] = {{1, 100}, {1000, 1000}, {1188, 500}, {4940, 500}, {5000, 0}};
    const struct motion_point at = {.step = 1000, .speed2 = 1000000};
    motion_plan_begin(&plan, &single, 0);
    TEST_ASSERT_TRUE(motion_plan_change_speed(&plan, &at, 500));

    assert_corners(expected, 5);
}

void test_a_change_of_speed_at_the_first_pulse_shows_where_it_began(void)
{
    const struct motion_point at = {.step = 1, .speed2 = 10000 + 4000};
    begin_single(5000, 100, 1000, 2000);
    TEST_ASSERT_TRUE(motion_plan_change_speed(&plan, &at, 100));

    TEST_ASSERT_EQUAL_UINT(4, motion_corners_of(&plan, corners));
    TEST_ASSERT_EQUAL_UINT64(1, corners[1].step);
    TEST_ASSERT_EQUAL_UINT32(118, corners[1].speed_steps_per_s);
}

void test_ten_sections_have_at_most_the_corners_there_is_room_for(void)
{
    struct motion_order order = {.start_speed_steps_per_s = 10, .sections = MOTION_SECTIONS};
    for (unsigned i = 0; i < MOTION_SECTIONS; i++) {
        order.section[i] = (struct motion_section){5000, i % 2U == 0 ? 100 : 200, 100};
    }
    motion_plan_begin(&plan, &order, 0);
    const struct motion_point at = {.step = 1, .speed2 = 300};

    TEST_ASSERT_TRUE(motion_plan_change_speed(&plan, &at, 300));

    TEST_ASSERT_LESS_OR_EQUAL_UINT(MOTION_CORNERS_MAX, motion_corners_of(&plan, corners));
}
