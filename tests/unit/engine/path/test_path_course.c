#include "path_course.h"
#include "path_fixed.h"
#include "path_rig.h"
#include "step_scale.h"
#include "unity.h"

static const uint32_t SPEED = 10000 * PATH_SPEED_UNITS;
static struct path_section section;
static struct path_course course;
static struct path_speeds speeds;

static uint64_t speed2_of(uint32_t steps_per_s)
{
    return (uint64_t)steps_per_s * steps_per_s * PATH_SPEED_UNITS * PATH_SPEED_UNITS;
}

/* 1000 steps, 10 000 steps/s, 1 000 000 steps/s^2: ramps of 50 steps. */
static void lay(uint32_t enter, uint32_t speed, uint32_t leave)
{
    struct path_entry entry = {.time = {.high = 5000}, .speed2 = speed2_of(enter)};
    const struct path_goal goal = {.exit_speed2 = speed2_of(leave), .speed = speed, .rests = speed == 0};
    path_course_lay(&course, &section, &entry, &goal, &speeds);
}

static void assert_leg(unsigned leg, int sign, uint32_t begin, uint32_t end, uint64_t tick)
{
    const struct path_leg *laid = &course.leg[leg];
    TEST_ASSERT_EQUAL_INT32(sign * 128000000, laid->accel);
    TEST_ASSERT_EQUAL_UINT64(begin * course.grains_per_step, laid->place.low);
    TEST_ASSERT_EQUAL_UINT64(end * course.grains_per_step, laid->end.low);
    TEST_ASSERT_EQUAL_UINT64(tick, laid->time.high);
}

static uint64_t pulse_tick(unsigned leg, uint32_t steps, uint32_t pulse)
{
    struct path_pulse at = path_course_pulse(&course, &course.leg[leg], steps, pulse);
    return at.ticks + (at.fraction >> 31U);
}

void setUp(void)
{
    struct path_vector vector = rig_vector(1000, 333, 10000, 1000000);
    path_section_take(&section, &vector);
}

void tearDown(void)
{
}

void test_a_vector_from_stand_to_stand_is_a_ramp_a_cruise_and_a_ramp(void)
{
    lay(0, SPEED, 0);
    TEST_ASSERT_EQUAL_UINT(3, course.legs);
    assert_leg(0, 1, 0, 50, 5000);
    assert_leg(1, 0, 50, 950, 845000);
    assert_leg(2, -1, 950, 1000, 8405000);
    TEST_ASSERT_EQUAL_UINT64(9245000, course.end_time.high);
}

void test_where_the_way_is_too_short_the_ramps_meet(void)
{
    lay(0, PATH_SPEED_MAX, 10000);
    TEST_ASSERT_EQUAL_UINT(2, course.legs);
    assert_leg(0, 1, 0, 525, 5000);
    TEST_ASSERT_EQUAL_UINT64(1000 * course.grains_per_step, course.leg[1].end.low);
}

void test_what_is_entered_too_fast_brakes_at_once(void)
{
    lay(10000, 5000 * PATH_SPEED_UNITS, 0);
    TEST_ASSERT_EQUAL_UINT(3, course.legs);
    TEST_ASSERT_EQUAL_INT32(-128000000, course.leg[0].accel);
    TEST_ASSERT_EQUAL_UINT64(course.grains_per_step * 75 / 2, course.leg[0].end.low);
    TEST_ASSERT_EQUAL_INT32(0, course.leg[1].accel);
    TEST_ASSERT_EQUAL_INT32(-128000000, course.leg[2].accel);
}

void test_a_stop_rests_where_its_ramp_ends(void)
{
    lay(10000, 0, 0);
    TEST_ASSERT_EQUAL_UINT(1, course.legs);
    TEST_ASSERT_EQUAL_UINT64(50 * course.grains_per_step, course.end.low);
    TEST_ASSERT_EQUAL_UINT64(845000, course.end_time.high);
}

void test_a_stop_at_a_stand_has_no_legs(void)
{
    lay(0, 0, 0);
    TEST_ASSERT_EQUAL_UINT(0, course.legs);
    TEST_ASSERT_EQUAL_UINT64(0, course.end.low);
}

void test_a_cruise_all_the_way_is_one_leg(void)
{
    lay(10000, SPEED, 10000);
    TEST_ASSERT_EQUAL_UINT(1, course.legs);
    assert_leg(0, 0, 0, 1000, 5000);
}

void test_the_pulses_of_each_axis_lie_where_its_share_of_the_way_is_whole(void)
{
    lay(0, SPEED, 0);
    TEST_ASSERT_EQUAL_UINT32(50, path_course_last_pulse(&course, course.leg[0].end, 1000));
    TEST_ASSERT_EQUAL_UINT32(16, path_course_last_pulse(&course, course.leg[0].end, 333));
    TEST_ASSERT_EQUAL_UINT32(333, path_course_last_pulse(&course, course.leg[2].end, 333));
    TEST_ASSERT_EQUAL_UINT32(0, path_course_last_pulse(&course, course.leg[2].end, 0));
}

/* From the exact curve: sqrt(2*s/A) on the ramp, (s - 50)/V after it. */
void test_pulses_are_due_when_the_path_is_at_their_places(void)
{
    lay(0, SPEED, 0);
    TEST_ASSERT_EQUAL_UINT64(5000 + 118794, pulse_tick(0, 1000, 1));
    TEST_ASSERT_EQUAL_UINT64(5000 + 168000, pulse_tick(0, 1000, 2));
    TEST_ASSERT_EQUAL_UINT64(5000 + 205860, pulse_tick(0, 333, 1));
    TEST_ASSERT_EQUAL_UINT64(5000 + 849 + 8400 * 100, pulse_tick(1, 1000, 50) + 849);
    TEST_ASSERT_EQUAL_UINT64(5000 + 9121206, pulse_tick(2, 1000, 999));
    TEST_ASSERT_EQUAL_UINT64(5000 + 9240000, pulse_tick(2, 333, 333));
}

void test_a_pulse_at_a_stand_has_no_slope(void)
{
    lay(0, SPEED, 0);
    TEST_ASSERT_EQUAL_UINT64(0, path_course_pulse(&course, &course.leg[2], 333, 333).slope256);
}

void test_a_pulse_at_a_corner_is_never_before_it(void)
{
    lay(10000, 5000 * PATH_SPEED_UNITS, 0);
    course.leg[0].slope.low = 0;
    course.leg[0].slope.high = 10000 * STEP_SLOPE_PER_SPEED - 1U;
    struct path_pulse at = path_course_pulse(&course, &course.leg[0], 1000, 0);
    TEST_ASSERT_EQUAL_UINT64(5000, at.ticks);
    TEST_ASSERT_EQUAL_UINT32(0, at.fraction);
}

void test_a_place_of_a_leg_is_known_exactly(void)
{
    lay(0, SPEED, 0);
    for (uint32_t step = 1; step < 50; step++) {
        struct path_entry up = path_course_at(&course, &course.leg[0], wide_multiply(course.grains_per_step, step));
        TEST_ASSERT_EQUAL_UINT64(step * path_section_gain_per_step(&section), up.speed2);
        struct path_entry down =
            path_course_at(&course, &course.leg[2], wide_multiply(course.grains_per_step, 1000U - step));
        TEST_ASSERT_EQUAL_UINT64(up.speed2, down.speed2);
        TEST_ASSERT_UINT64_WITHIN(1, 9250000U - up.time.high, down.time.high);
    }
    struct path_entry cruise = path_course_at(&course, &course.leg[1], wide_multiply(course.grains_per_step, 51));
    TEST_ASSERT_EQUAL_UINT64(845000 + 8400, cruise.time.high);
    TEST_ASSERT_EQUAL_UINT64(speed2_of(10000), cruise.speed2);
}

void test_a_vector_that_lasts_longer_than_time_never_ends(void)
{
    struct path_vector vector = rig_vector(INT32_MAX, 1, 1, 1);
    struct path_entry entry = {.time = {.high = PATH_FIXED_NEVER}, .speed2 = 1};
    path_section_take(&section, &vector);
    path_course_lay(&course, &section, &entry, &(struct path_goal){.exit_speed2 = 1, .speed = 1}, &speeds);
    TEST_ASSERT_EQUAL_UINT64(2U * PATH_FIXED_NEVER, course.end_time.high);
}
