#include <string.h>

#include "base_tick.h"
#include "motion_plan.h"
#include "segment_view.h"
#include "step_scale.h"
#include "unity.h"

/* What stops and changes of speed make of a plan, and runs too long for one segment. That every pulse is exact is shown
 * elsewhere, against the reference. */

enum { SEGMENTS_MAX = 64 };

static struct motion_plan plan;
static struct step_segment segments[SEGMENTS_MAX];
static unsigned count;

void setUp(void)
{
}

void tearDown(void)
{
}

static struct motion_order order_single(uint64_t steps, uint32_t start_speed, uint32_t speed, uint32_t accel)
{
    return (struct motion_order){
        .section = {{steps, speed, accel}},
        .start_speed_steps_per_s = start_speed,
        .sections = 1,
    };
}

static void begin(struct motion_order order)
{
    motion_plan_begin(&plan, &order, 1000);
}

static void begin_two(uint32_t start_speed, struct motion_section first, struct motion_section second)
{
    begin((struct motion_order){
        .section = {first, second},
        .start_speed_steps_per_s = start_speed,
        .sections = 2,
    });
}

static struct motion_point point_at(uint64_t step, uint64_t speed2)
{
    return (struct motion_point){.time = {.ticks = 500000}, .step = step, .speed2 = speed2};
}

static bool stop_at(uint64_t step, uint64_t speed2)
{
    const struct motion_point at = point_at(step, speed2);
    return motion_plan_stop(&plan, &at);
}

static bool change_at(uint64_t step, uint64_t speed2, uint32_t speed)
{
    const struct motion_point at = point_at(step, speed2);
    return motion_plan_change_speed(&plan, &at, speed);
}

/* Takes all segments; returns the pulses on them. */
static uint64_t take_segments(void)
{
    uint64_t pulses = 0;
    for (count = 0; count < SEGMENTS_MAX && motion_plan_next(&plan, &segments[count]); count++) {
        pulses += segments[count].steps;
    }
    return pulses;
}

/* Segments by their pulses, and whether the speed rises (+1), stays (0) or falls (-1) on them. */
static void assert_segment(unsigned index, uint32_t steps, int sign)
{
    TEST_ASSERT_LESS_THAN_UINT_MESSAGE(count, index, "no such segment");
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(steps, segments[index].steps, "steps");
    int32_t accel = segments[index].accel;
    TEST_ASSERT_EQUAL_INT_MESSAGE(sign, accel > 0 ? 1 : accel < 0 ? -1 : 0, "sign of the acceleration");
}

/* Stops */

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

void test_a_stop_of_a_stop_is_none_and_changes_nothing(void)
{
    begin(order_single(5000, 100, 1000, 2000));
    (void)stop_at(1000, 1000000);
    struct motion_plan before;
    memcpy(&before, &plan, sizeof before);

    TEST_ASSERT_FALSE(stop_at(1001, 996000));

    TEST_ASSERT_EQUAL_MEMORY(&before, &plan, sizeof before);
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

void test_a_stop_at_a_border_takes_the_acceleration_behind_it(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(stop_at(4000, 10000 + 400000));

    TEST_ASSERT_EQUAL_UINT64(200, take_segments());
}

void test_a_stop_in_the_last_section_marks_nothing(void)
{
    begin_two(100, (struct motion_section){4000, 2000, 2000}, (struct motion_section){5000, 2000, 1000});

    TEST_ASSERT_TRUE(stop_at(4000, 4000000));
    (void)take_segments();

    TEST_ASSERT_FALSE(segments[0].marked);
}

void test_a_stop_begins_at_the_time_of_its_point(void)
{
    begin(order_single(5000, 100, 1000, 2000));

    (void)stop_at(1000, 1000000);
    (void)take_segments();

    TEST_ASSERT_EQUAL_UINT64(0, seen_at(&segments[0], 500000).residual);
    TEST_ASSERT_EQUAL_UINT64(1000U * STEP_SLOPE_PER_SPEED, seen_at(&segments[0], 500000).slope);
}

/* Changes of speed */

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

void test_a_change_lets_nothing_jump_in_the_sections_behind_it(void)
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

void test_a_change_at_a_border_acts_on_the_section_behind_it(void)
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

void test_a_change_of_a_stop_is_none(void)
{
    begin(order_single(5000, 100, 1000, 2000));
    (void)stop_at(1000, 1000000);

    TEST_ASSERT_FALSE(change_at(1001, 996000, 500));
    TEST_ASSERT_EQUAL_UINT64(247, take_segments());
}

void test_a_changed_move_can_be_stopped(void)
{
    begin(order_single(5000, 100, 1000, 2000));
    (void)change_at(1000, 1000000, 500);

    TEST_ASSERT_TRUE(stop_at(1010, 960000));

    TEST_ASSERT_EQUAL_UINT64(237, take_segments());
}

/* Runs beyond what a segment counts */

enum { PIECE = 1 << 30 };

void test_a_run_without_end_comes_in_pieces(void)
{
    begin(order_single(MOTION_ENDLESS_STEPS, 100, 1000, 2000));

    (void)take_segments();

    TEST_ASSERT_EQUAL_UINT(SEGMENTS_MAX, count);
    assert_segment(0, 247, 1);
    assert_segment(1, PIECE, 0);
    assert_segment(2, PIECE, 0);
    assert_segment(SEGMENTS_MAX - 1, PIECE, 0);
}

/* 5250 ticks a pulse: no piece begins off the tick. */
void test_pieces_join_on_the_tick(void)
{
    begin(order_single(MOTION_ENDLESS_STEPS, 16000, 16000, 2000));

    (void)take_segments();

    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_UINT32((uint32_t)(1000U + UINT64_C(5250) * (PIECE * i + 1U)), segments[i].tick);
        TEST_ASSERT_EQUAL_UINT64(0, segments[i].residual);
    }
}

/* 84 MHz / 15999 is no whole number; a piece loses less than 2^-32 tick, and its first pulse is on the nearest one. */
void test_pieces_off_the_tick_do_not_drift(void)
{
    begin(order_single(MOTION_ENDLESS_STEPS, 15999, 15999, 2000));

    (void)take_segments();

    for (uint64_t i = 0; i < count; i++) {
        uint64_t pulses = i * PIECE + 1U;
        uint64_t ticks = pulses / 15999U * TICK_HZ + (pulses % 15999U * TICK_HZ + 15999U / 2U) / 15999U;
        TEST_ASSERT_EQUAL_UINT32((uint32_t)(1000U + ticks), segments[i].tick);
    }
}

void test_the_longest_section_has_all_its_pulses_and_ends_with_its_ramp(void)
{
    begin(order_single(MOTION_SECTION_STEPS_MAX, 100, 1000, 1000));
    uint64_t pulses = 0;
    struct step_segment segment;

    while (motion_plan_next(&plan, &segment)) {
        pulses += segment.steps;
    }

    TEST_ASSERT_EQUAL_UINT64(MOTION_SECTION_STEPS_MAX, pulses);
    TEST_ASSERT_EQUAL_UINT32(495, segment.steps);
    TEST_ASSERT_LESS_THAN_INT32(0, segment.accel);
}

void test_a_run_without_end_is_stopped_far_from_its_start(void)
{
    begin(order_single(MOTION_ENDLESS_STEPS, 100, 1000, 1000));

    TEST_ASSERT_TRUE(stop_at((UINT64_C(1) << 33) + 5U, 1000000));

    TEST_ASSERT_EQUAL_UINT64(495, take_segments());
}

void test_a_run_without_end_is_changed_far_from_its_start(void)
{
    begin(order_single(MOTION_ENDLESS_STEPS, 100, 1000, 1000));

    TEST_ASSERT_TRUE(change_at((UINT64_C(1) << 33) + 5U, 1000000, 900));

    (void)take_segments();
    assert_segment(0, 95, -1);
    assert_segment(1, PIECE, 0);
}
