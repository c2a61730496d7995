#include "plan_rig.h"
#include "step_scale.h"
#include "unity.h"

/* What changes of speed make of a plan. That every pulse is exact is shown elsewhere, against the reference. */

void setUp(void)
{
}

void tearDown(void)
{
}

void test_a_change_to_a_higher_speed_rises_with_the_acceleration_in_force(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(change_at(1000, 1000000, 1100));

    /* (1100^2 - 1000^2) / 4000 = 52.5 and (1100^2 - 100^2) / 4000 = 300. */
    TEST_ASSERT_EQUAL_UINT64(4000, take_segments());
    TEST_ASSERT_EQUAL_UINT(3, count);
    assert_segment(0, 52, 1);
    assert_segment(1, 4000 - 300 - 52, 0);
    assert_segment(2, 300, -1);
}

void test_a_change_to_a_lower_speed_falls_with_the_acceleration_in_force(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(change_at(1000, 1000000, 500));

    /* (1000^2 - 500^2) / 4000 = 187.5 and (500^2 - 100^2) / 4000 = 60. */
    TEST_ASSERT_EQUAL_UINT64(4000, take_segments());
    TEST_ASSERT_EQUAL_UINT(3, count);
    assert_segment(0, 187, -1);
    assert_segment(1, 4000 - 60 - 187, 0);
    assert_segment(2, 60, -1);
}

void test_a_change_to_a_speed_that_the_way_does_not_allow_comes_as_near_as_it_can(void)
{
    begin(order_single(2000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(change_at(1000, 1000000, 16000));

    TEST_ASSERT_EQUAL_UINT64(1000, take_segments());
    TEST_ASSERT_EQUAL_UINT(2, count);
}

void test_a_change_on_the_final_ramp_cannot_keep_the_motor_from_its_target(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(change_at(4900, 10000 + 4000 * 100, 16000));

    TEST_ASSERT_EQUAL_UINT64(100, take_segments());
    TEST_ASSERT_EQUAL_UINT(1, count);
    assert_segment(0, 100, -1);
}

void test_a_change_to_a_speed_below_S_jumps_when_the_brake_has_reached_S(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(change_at(1000, 1000000, 40));

    TEST_ASSERT_EQUAL_UINT64(4000, take_segments());
    TEST_ASSERT_EQUAL_UINT(2, count);
    assert_segment(0, 247, -1);
    assert_segment(1, 4000 - 247, 0);
    TEST_ASSERT_EQUAL_UINT64(40U * STEP_SLOPE_PER_SPEED, segments[1].slope);
}

void test_a_change_to_a_speed_below_S_may_jump_at_the_very_end(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(change_at(4900, 10000 + 4000 * 100, 40));

    TEST_ASSERT_EQUAL_UINT64(100, take_segments());
    TEST_ASSERT_EQUAL_UINT64(40 * 40, plan.exit_speed2[0]);
}

void test_a_change_between_speeds_below_S_is_taken_at_once(void)
{
    begin(order_single(5000, 100, 40, 2000));

    TEST_ASSERT_TRUE(change_at(1000, 1600, 90));

    TEST_ASSERT_EQUAL_UINT64(4000, take_segments());
    TEST_ASSERT_EQUAL_UINT(1, count);
    TEST_ASSERT_EQUAL_UINT64(90U * STEP_SLOPE_PER_SPEED, segments[0].slope);
}

void test_a_change_lets_nothing_jump_in_the_sections_after_it(void)
{
    begin_two(1000, (struct motion_section){100, 20, 1}, (struct motion_section){1000, 1000, 1});

    TEST_ASSERT_TRUE(change_at(50, 400, 10));

    TEST_ASSERT_EQUAL_UINT64(1050, take_segments());
    TEST_ASSERT_EQUAL_UINT(2, count);
    assert_segment(0, 50, 0);
    assert_segment(1, 1000, 1);
    /* One step on: the square root of 102. */
    TEST_ASSERT_UINT64_WITHIN(STEP_SLOPE_PER_SPEED / 100000U, STEP_SLOPE_PER_SPEED * 1009950U / 100000U,
                              segments[1].slope);
}

/* From 1000 steps/s to sqrt(996000) = 997.998 steps/s with 2000 steps/s^2. */
void test_the_first_pulse_of_a_braking_ramp_stands_in_its_segment(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    (void)change_at(1000, 1000000, 500);
    (void)take_segments();

    TEST_ASSERT_UINT32_WITHIN(1, 500000 + 84084, segments[0].tick);
}

void test_a_change_in_a_section_leaves_it_faster_than_its_new_speed_where_the_way_is_short(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(change_at(3990, 4000000, 200));

    TEST_ASSERT_EQUAL_UINT64(4000000 - 40000, plan.exit_speed2[0]);
    TEST_ASSERT_EQUAL_UINT64(5010, take_segments());
}

void test_a_change_in_a_section_leaves_it_with_its_new_speed_where_the_way_is_long_enough(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(change_at(1010, 4000000, 200));

    TEST_ASSERT_EQUAL_UINT64(40000, plan.exit_speed2[0]);
}

void test_a_change_acts_on_its_section_only(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    (void)change_at(1010, 4000000, 200);

    TEST_ASSERT_EQUAL_UINT32(200, plan.order.section[0].speed_steps_per_s);
    TEST_ASSERT_EQUAL_UINT32(2000, plan.order.section[1].speed_steps_per_s);
}

void test_a_change_at_a_border_acts_on_the_section_after_it(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(change_at(4000, 4000000, 200));

    TEST_ASSERT_EQUAL_UINT32(2000, plan.order.section[0].speed_steps_per_s);
    TEST_ASSERT_EQUAL_UINT32(200, plan.order.section[1].speed_steps_per_s);
}

void test_a_change_at_the_border_of_the_last_section_keeps_its_mark(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    (void)change_at(4000, 4000000, 200);
    (void)take_segments();

    TEST_ASSERT_TRUE(segments[0].marked);
}

void test_a_change_inside_the_last_section_marks_it_not_again(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    (void)change_at(4001, 4000000, 200);
    (void)take_segments();

    TEST_ASSERT_FALSE(segments[0].marked);
}

void test_a_change_can_be_changed(void)
{
    begin(order_single(5000, 100, 1000, 2000));
    (void)change_at(1000, 1000000, 500);

    TEST_ASSERT_TRUE(change_at(1100, 600000, 700));

    TEST_ASSERT_EQUAL_UINT64(3900, take_segments());
}

void test_a_change_at_the_last_pulse_is_none(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_FALSE(change_at(5000, 10000, 500));
    TEST_ASSERT_EQUAL_UINT32(1000, plan.order.section[0].speed_steps_per_s);
}

void test_a_changed_move_can_be_stopped(void)
{
    begin(order_single(5000, 100, 1000, 2000));
    (void)change_at(1000, 1000000, 500);

    TEST_ASSERT_TRUE(stop_at(1010, 960000));

    TEST_ASSERT_EQUAL_UINT64(237, take_segments());
}
