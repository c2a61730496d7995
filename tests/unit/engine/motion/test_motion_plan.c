#include "plan_rig.h"
#include "segment_view.h"
#include "step_scale.h"
#include "unity.h"

/* How orders become segments. That every pulse is exact is shown elsewhere, against the reference. */

void setUp(void)
{
}

void tearDown(void)
{
}

/* The manual's ninth example. */
static void begin_manual(void)
{
    begin((struct motion_order){
        .section = {{2000, 500, 2000},
                    {2000, 2000, 2000},
                    {5000, 500, 2000},
                    {5000, 3000, 1000},
                    {2000, 1500, 1000},
                    {2000, 500, 1000}},
        .start_speed_steps_per_s = 100,
        .sections = 6,
    });
}

static void assert_exits(const uint64_t *expected, unsigned sections)
{
    for (unsigned i = 0; i < sections; i++) {
        TEST_ASSERT_EQUAL_UINT64(expected[i], plan.exit_speed2[i]);
    }
}

void test_a_long_move_is_a_ramp_a_cruise_and_a_ramp(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_EQUAL_UINT64(5000, take_segments());
    TEST_ASSERT_EQUAL_UINT(3, count);
    assert_segment(0, 247, 1);
    assert_segment(1, 4752 - 247, 0);
    assert_segment(2, 248, -1);
}

void test_the_first_segment_begins_at_the_start_of_the_move(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    (void)take_segments();

    TEST_ASSERT_EQUAL_UINT64(0, seen_at(&segments[0], 1000).residual);
    TEST_ASSERT_EQUAL_UINT64(100U * STEP_SLOPE_PER_SPEED, seen_at(&segments[0], 1000).slope);
}

void test_a_short_move_is_two_ramps(void)
{
    begin(order_single(100, 100, 1000, 2000));

    TEST_ASSERT_EQUAL_UINT64(100, take_segments());
    TEST_ASSERT_EQUAL_UINT(2, count);
    assert_segment(0, 50, 1);
    assert_segment(1, 50, -1);
}

void test_a_ramp_without_a_whole_step_is_no_segment(void)
{
    begin(order_single(1, 100, 1000, 2000));

    TEST_ASSERT_EQUAL_UINT64(1, take_segments());
    TEST_ASSERT_EQUAL_UINT(1, count);
    assert_segment(0, 1, -1);
}

void test_a_top_speed_below_S_is_driven_throughout(void)
{
    begin(order_single(5000, 100, 99, 2000));

    TEST_ASSERT_EQUAL_UINT64(5000, take_segments());
    TEST_ASSERT_EQUAL_UINT(1, count);
    assert_segment(0, 5000, 0);
    TEST_ASSERT_EQUAL_UINT64(99U * STEP_SLOPE_PER_SPEED, segments[0].slope);
}

void test_a_plan_that_is_used_up_stays_so(void)
{
    begin(order_single(5, 100, 100, 2000));
    (void)take_segments();

    struct step_segment segment;
    TEST_ASSERT_FALSE(motion_plan_next(&plan, &segment));
    TEST_ASSERT_FALSE(motion_plan_next(&plan, &segment));
}

void test_a_move_starts_at_S(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_EQUAL_UINT64(10000, plan.begin_speed2);
}

void test_the_start_speed_is_lowered_where_the_first_section_cannot_brake(void)
{
    begin_two(1000, (struct motion_section){1, 1000, 1}, (struct motion_section){100, 10, 1});

    TEST_ASSERT_EQUAL_UINT64(100 + 2, plan.begin_speed2);
    TEST_ASSERT_EQUAL_UINT64(100, plan.exit_speed2[0]);
}

void test_the_start_speed_is_not_lowered_where_the_first_section_can_just_brake(void)
{
    begin_two(1000, (struct motion_section){495, 1000, 1000}, (struct motion_section){100, 100, 1});

    TEST_ASSERT_EQUAL_UINT64(1000000, plan.begin_speed2);

    begin_two(1000, (struct motion_section){494, 1000, 1000}, (struct motion_section){100, 100, 1});

    TEST_ASSERT_EQUAL_UINT64(10000 + 988000, plan.begin_speed2);
}

void test_the_end_is_slower_than_S_where_the_way_up_is_too_short(void)
{
    begin_two(1000, (struct motion_section){100, 5, 1}, (struct motion_section){3, 1000, 2});

    TEST_ASSERT_EQUAL_UINT64(25 + 12, plan.exit_speed2[1]);
    TEST_ASSERT_EQUAL_UINT64(103, take_segments());
}

void test_borders_are_as_fast_as_both_sections_allow(void)
{
    const uint64_t borders[] = {500 * 500, 500 * 500, 500 * 500, 1500 * 1500, 500 * 500, 100 * 100};
    begin_manual();

    assert_exits(borders, 6);
}

/* Entered at 500 and left at 1500: the peak is sqrt((500^2 + 1500^2) / 2 + 1000 * 5000). */
void test_the_fourth_section_of_the_manuals_example_peaks_at_2500(void)
{
    begin_manual();
    while (plan.progress.section < 3 || plan.progress.leg == 0) {
        TEST_ASSERT_TRUE(motion_plan_next(&plan, &segments[0]));
    }

    TEST_ASSERT_EQUAL_UINT64(2U * 500U * 500U, plan.progress.profile.enter);
    TEST_ASSERT_EQUAL_UINT64(2U * 2500U * 2500U, plan.progress.profile.turn);
    TEST_ASSERT_EQUAL_UINT64(2U * 1500U * 1500U, plan.progress.profile.exit);
}

void test_the_manuals_example_has_all_its_pulses(void)
{
    begin_manual();

    TEST_ASSERT_EQUAL_UINT64(18000, take_segments());
}

void test_a_border_is_no_faster_than_the_way_up_to_it_allows(void)
{
    begin_two(10, (struct motion_section){50, 1000, 20}, (struct motion_section){50000, 1000, 20});

    TEST_ASSERT_EQUAL_UINT64(100 + 2 * 20 * 50, plan.exit_speed2[0]);
}

void test_a_border_is_no_faster_than_the_way_down_after_it_allows(void)
{
    begin_two(10, (struct motion_section){50000, 1000, 20}, (struct motion_section){50, 1000, 30});

    TEST_ASSERT_EQUAL_UINT64(100 + 2 * 30 * 50, plan.exit_speed2[0]);
}

void test_look_ahead_reaches_through_sections_of_one_step(void)
{
    struct motion_order order = {.start_speed_steps_per_s = 1, .sections = MOTION_SECTIONS};
    for (unsigned i = 0; i < MOTION_SECTIONS; i++) {
        order.section[i] = (struct motion_section){1, 16000, i + 1U};
    }
    begin(order);

    /* After section i: 1 + 2 * (1 + 2 + ... + i) on the way up, 1 + 2 * (10 + 9 + ... + (i + 1)) on the way down. */
    const uint64_t borders[] = {3, 7, 13, 21, 31, 43, 55, 39, 21, 1};
    assert_exits(borders, MOTION_SECTIONS);
    TEST_ASSERT_EQUAL_UINT64(MOTION_SECTIONS, take_segments());
}

void test_only_the_begin_of_the_last_section_is_marked(void)
{
    begin_two(100, (struct motion_section){1000, 500, 2000}, (struct motion_section){1000, 500, 2000});

    (void)take_segments();

    TEST_ASSERT_EQUAL_UINT(4, count);
    TEST_ASSERT_FALSE(segments[0].marked);
    TEST_ASSERT_FALSE(segments[1].marked);
    TEST_ASSERT_TRUE(segments[2].marked);
    TEST_ASSERT_FALSE(segments[3].marked);
}

void test_the_begin_of_the_last_section_is_marked_after_a_single_step(void)
{
    begin_two(100, (struct motion_section){1, 500, 2000}, (struct motion_section){1000, 500, 2000});

    (void)take_segments();

    TEST_ASSERT_FALSE(segments[0].marked);
    TEST_ASSERT_TRUE(segments[1].marked);
}

void test_a_single_section_is_not_marked(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    (void)take_segments();

    TEST_ASSERT_FALSE(segments[0].marked || segments[1].marked || segments[2].marked);
}
