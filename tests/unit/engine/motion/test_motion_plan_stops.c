#include "plan_rig.h"
#include "segment_view.h"
#include "step_scale.h"
#include "unity.h"

/* What stops make of a plan. That every pulse is exact is shown elsewhere, against the reference. */

void setUp(void)
{
}

void tearDown(void)
{
}

void test_a_stop_brakes_to_S_and_ends_at_the_last_step_on_the_ramp(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(stop_at(1000, 1000000));

    TEST_ASSERT_EQUAL_UINT64(247, take_segments());
    TEST_ASSERT_EQUAL_UINT(1, count);
    assert_segment(0, 247, -1);
}

void test_a_stop_ramp_of_whole_steps_has_all_of_them(void)
{
    begin(order_single(5000, 100, 1000, 1000));

    TEST_ASSERT_TRUE(stop_at(1000, 1000000));

    TEST_ASSERT_EQUAL_UINT64(495, take_segments());
}

void test_a_stop_ramp_shorter_than_a_step_makes_no_pulse(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(stop_at(10, 10000 + 3999));
    TEST_ASSERT_EQUAL_UINT64(0, take_segments());

    begin(order_single(5000, 100, 1000, 2000));
    TEST_ASSERT_TRUE(stop_at(10, 10000 + 4000));
    TEST_ASSERT_EQUAL_UINT64(1, take_segments());
}

void test_a_stop_at_S_makes_no_pulse(void)
{
    begin(order_single(5000, 100, 100, 2000));

    TEST_ASSERT_TRUE(stop_at(1000, 10000));

    TEST_ASSERT_EQUAL_UINT64(0, take_segments());
}

void test_a_stop_below_S_makes_no_pulse(void)
{
    begin(order_single(5000, 100, 40, 2000));

    TEST_ASSERT_TRUE(stop_at(1000, 1600));

    TEST_ASSERT_EQUAL_UINT64(0, take_segments());
}

void test_a_stop_on_the_final_ramp_leaves_its_pulses(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(stop_at(4900, 10000 + 4000 * 100));

    TEST_ASSERT_EQUAL_UINT64(100, take_segments());
}

void test_a_stop_at_the_last_pulse_is_none(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_FALSE(stop_at(5000, 10000));
}

/* 100 steps with A2000 from 1900 leave 3 210 000; 3 200 000 of it with A1000 are 1600 steps. */
void test_a_stop_goes_on_in_the_next_section_with_its_acceleration(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(stop_at(3900, 1900 * 1900));

    TEST_ASSERT_EQUAL_UINT64(100 + 1600, take_segments());
    TEST_ASSERT_EQUAL_UINT(2, count);
    assert_segment(0, 100, -1);
    assert_segment(1, 1600, -1);
    TEST_ASSERT_EQUAL_INT32(-1000 * (int32_t)STEP_ACCEL_PER_ACCEL, segments[1].accel);
}

void test_a_stop_that_reaches_S_just_at_a_border_ends_there(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(stop_at(3900, 10000 + 400000));

    TEST_ASSERT_EQUAL_UINT64(100, take_segments());
}

/* 100 steps to S, and 102 to the border, which could be passed below S. */
void test_a_stop_that_reaches_S_shortly_before_a_border_ends_where_it_does(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(stop_at(3898, 10000 + 400000));

    TEST_ASSERT_EQUAL_UINT64(100, take_segments());
    TEST_ASSERT_EQUAL_UINT64(10000, plan.exit_speed2[0]);
}

void test_a_stop_at_a_border_takes_the_acceleration_after_it(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(stop_at(4000, 10000 + 400000));

    TEST_ASSERT_EQUAL_UINT64(200, take_segments());
}

void test_a_stop_in_the_last_section_marks_nothing(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(stop_at(4001, 4000000));
    (void)take_segments();

    TEST_ASSERT_FALSE(segments[0].marked);
}

void test_a_stop_that_begins_where_the_last_section_does_marks_it(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(stop_at(4000, 4000000));
    (void)take_segments();

    TEST_ASSERT_TRUE(segments[0].marked);
}

void test_a_stop_that_brakes_into_the_last_section_marks_it(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(stop_at(3900, 4000000));
    (void)take_segments();

    TEST_ASSERT_EQUAL_UINT(2, count);
    TEST_ASSERT_FALSE(segments[0].marked);
    TEST_ASSERT_TRUE(segments[1].marked);
}

void test_a_stop_that_brakes_into_a_section_before_the_last_marks_nothing(void)
{
    begin((struct motion_order){
        .section = {{4000, 2000, 2000}, {5000, 2000, 2000}, {5000, 2000, 2000}},
        .start_speed_steps_per_s = 100,
        .sections = 3,
    });

    TEST_ASSERT_TRUE(stop_at(3900, 4000000));
    (void)take_segments();

    TEST_ASSERT_EQUAL_UINT(2, count);
    TEST_ASSERT_FALSE(segments[0].marked || segments[1].marked);
}

void test_a_stop_begins_at_the_time_of_its_point(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    (void)stop_at(1000, 1000000);
    (void)take_segments();

    TEST_ASSERT_EQUAL_UINT64(0, seen_at(&segments[0], 500000).residual);
    TEST_ASSERT_EQUAL_UINT64(1000U * STEP_SLOPE_PER_SPEED, seen_at(&segments[0], 500000).slope);
}

/* What may be done before a stop is planned */

static bool brake_at(uint64_t step, uint64_t speed, struct motion_brake *brake)
{
    return motion_plan_brake(&plan, step, speed * STEP_SLOPE_PER_SPEED, brake);
}

/* (1000^2 - 100^2) / 4000 = 247.5. */
void test_a_motor_may_brake_without_a_plan_for_half_of_the_way_down_to_S(void)
{
    struct motion_brake brake;
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(brake_at(1000, 1000, &brake));

    TEST_ASSERT_EQUAL_INT32(2000 * (int32_t)STEP_ACCEL_PER_ACCEL, brake.accel);
    TEST_ASSERT_EQUAL_UINT64(1000 + 123, brake.until);
}

void test_a_motor_may_not_brake_without_a_plan_beyond_the_section(void)
{
    struct motion_brake brake;
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(brake_at(3990, 2000, &brake));

    TEST_ASSERT_EQUAL_INT32(2000 * (int32_t)STEP_ACCEL_PER_ACCEL, brake.accel);
    TEST_ASSERT_EQUAL_UINT64(4000, brake.until);
}

/* (2000^2 - 100^2) / 2000 = 1995. */
void test_a_motor_brakes_at_a_border_with_the_acceleration_after_it(void)
{
    struct motion_brake brake;
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(brake_at(4000, 2000, &brake));

    TEST_ASSERT_EQUAL_INT32(1000 * (int32_t)STEP_ACCEL_PER_ACCEL, brake.accel);
    TEST_ASSERT_EQUAL_UINT64(4000 + 1995 / 2, brake.until);
}

void test_a_motor_at_S_or_below_has_no_step_to_brake_on(void)
{
    struct motion_brake brake;
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_TRUE(brake_at(10, 100, &brake));
    TEST_ASSERT_EQUAL_UINT64(10, brake.until);
    TEST_ASSERT_TRUE(brake_at(20, 40, &brake));
    TEST_ASSERT_EQUAL_UINT64(20, brake.until);
}

void test_a_motor_does_not_brake_at_its_last_pulse(void)
{
    struct motion_brake brake;
    begin(order_single(5000, 100, 1000, 2000));

    TEST_ASSERT_FALSE(brake_at(5000, 100, &brake));
    TEST_ASSERT_TRUE(brake_at(4999, 120, &brake));
}
