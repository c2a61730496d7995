#include "motion_leg.h"
#include "motion_profile.h"
#include "segment_view.h"
#include "step_scale.h"
#include "unity.h"

#define HALF_TICK UINT32_C(0x80000000)

static uint64_t slope_of(uint32_t speed_steps_per_s)
{
    return speed_steps_per_s * STEP_SLOPE_PER_SPEED;
}

/* From 100 to 300 steps/s with 1000 steps/s^2, or back: 40 steps in 0.2 s. */
static struct motion_leg ramp(uint32_t from_speed, uint32_t to_speed)
{
    return (struct motion_leg){
        .start = {.ticks = 5000},
        .from = {.step = 7},
        .to = {.step = 47},
        .from_slope = slope_of(from_speed),
        .to_slope = slope_of(to_speed),
        .pulse_twice_speed2 = 2U * motion_square(from_speed),
        .accel = 1000 * STEP_ACCEL_PER_ACCEL,
    };
}

static struct motion_leg cruise(uint32_t speed, uint32_t steps)
{
    return (struct motion_leg){
        .start = {.ticks = 5000},
        .from = {.step = 7},
        .to = {.step = 7 + steps},
        .from_slope = slope_of(speed),
        .to_slope = slope_of(speed),
    };
}

void setUp(void)
{
}

void tearDown(void)
{
}

void test_the_slope_of_a_whole_speed_is_exact(void)
{
    const uint32_t speeds[] = {1, 2, 3, 1999, 2000, 16000, 200000, MOTION_SPEED_MAX};
    for (unsigned i = 0; i < sizeof speeds / sizeof speeds[0]; i++) {
        TEST_ASSERT_EQUAL_UINT64(slope_of(speeds[i]), motion_leg_slope(2U * motion_square(speeds[i])));
    }
}

void test_the_slope_of_an_irrational_speed_is_the_nearest(void)
{
    /* The square roots of 2 and of a half. */
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(30411248445), motion_leg_slope(2U * 2U));
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(15205624223), motion_leg_slope(1U));
}

void test_a_ramp_lasts_as_long_as_the_speed_takes_to_change(void)
{
    struct motion_leg up = ramp(100, 300);
    struct motion_leg down = ramp(300, 100);

    motion_leg_set_end(&up);
    motion_leg_set_end(&down);

    TEST_ASSERT_EQUAL_UINT64(5000 + TICK_HZ / 5U, up.end.ticks);
    TEST_ASSERT_EQUAL_UINT32(0, up.end.fraction);
    TEST_ASSERT_EQUAL_UINT64(up.end.ticks, down.end.ticks);
}

void test_a_ramp_without_change_takes_no_time(void)
{
    struct motion_leg leg = ramp(300, 300);

    motion_leg_set_end(&leg);

    TEST_ASSERT_EQUAL_UINT64(5000, leg.end.ticks);
}

void test_a_cruise_lasts_as_long_as_its_way_takes(void)
{
    struct motion_leg leg = cruise(32, 1);

    motion_leg_set_end(&leg);

    TEST_ASSERT_EQUAL_UINT64(5000 + TICK_HZ / 32U, leg.end.ticks);
}

void test_the_end_keeps_parts_of_a_tick(void)
{
    struct motion_leg leg = cruise(16000, 3);
    leg.to.quanta = STEP_QUANTA / 10500U;

    motion_leg_set_end(&leg);

    TEST_ASSERT_EQUAL_UINT64(5000 + 3U * 5250U, leg.end.ticks);
    TEST_ASSERT_EQUAL_HEX32(HALF_TICK, leg.end.fraction);
}

void test_pulses_are_the_whole_steps_after_the_begin_up_to_the_end(void)
{
    struct motion_leg leg = cruise(100, 4);
    leg.from.quanta = STEP_QUANTA - 1U;

    TEST_ASSERT_EQUAL_UINT64(4, motion_leg_pulses(&leg));
}

void test_a_segment_of_a_cruise_holds_place_and_speed_at_its_start(void)
{
    struct motion_leg leg = cruise(1000, 10);
    leg.from.quanta = STEP_QUANTA / 4U;
    motion_leg_set_end(&leg);

    struct step_segment segment = motion_leg_segment(&leg);

    TEST_ASSERT_EQUAL_UINT64(STEP_QUANTA / 4U, seen_at(&segment, 5000).residual);
    TEST_ASSERT_EQUAL_UINT64(slope_of(1000), segment.slope);
    TEST_ASSERT_EQUAL_INT32(0, segment.accel);
    TEST_ASSERT_EQUAL_UINT32(10, segment.steps);
    TEST_ASSERT_EQUAL_UINT32(5000 + 84000 / 4 * 3, segment.tick);
}

void test_a_cruise_that_starts_between_ticks_is_given_from_the_next_tick(void)
{
    struct motion_leg leg = cruise(1000, 10);
    leg.start.fraction = HALF_TICK;
    motion_leg_set_end(&leg);

    struct step_segment segment = motion_leg_segment(&leg);

    TEST_ASSERT_EQUAL_UINT64(slope_of(1000) / 2U, seen_at(&segment, 5001).residual);
}

void test_a_cruise_whose_first_step_is_due_before_the_next_tick_has_it_there(void)
{
    struct motion_leg leg = cruise(1000, 10);
    leg.start.fraction = HALF_TICK;
    leg.from.quanta = STEP_QUANTA - 1U;
    motion_leg_set_end(&leg);

    TEST_ASSERT_EQUAL_UINT32(5001, motion_leg_segment(&leg).tick);
}

void test_a_rising_ramp_is_given_from_its_start(void)
{
    struct motion_leg leg = ramp(100, 300);
    leg.from.quanta = 12345;
    motion_leg_set_end(&leg);

    struct step_segment segment = motion_leg_segment(&leg);

    TEST_ASSERT_EQUAL_UINT64(12345, seen_at(&segment, 5000).residual);
    TEST_ASSERT_EQUAL_UINT64(slope_of(100), seen_at(&segment, 5000).slope);
    TEST_ASSERT_EQUAL_INT32(1000 * STEP_ACCEL_PER_ACCEL, segment.accel);
    TEST_ASSERT_EQUAL_UINT32(40, segment.steps);
}

/* Half a tick of a ramp: slope / 2 + accel / 4, and the slope has risen by accel. */
void test_a_rising_ramp_that_starts_between_ticks_is_given_from_the_next_tick(void)
{
    struct motion_leg leg = ramp(100, 300);
    leg.start.fraction = HALF_TICK;
    motion_leg_set_end(&leg);

    struct step_segment segment = motion_leg_segment(&leg);

    TEST_ASSERT_EQUAL_UINT64(slope_of(100) / 2U + leg.accel / 4U, seen_at(&segment, 5001).residual);
    TEST_ASSERT_EQUAL_UINT64(slope_of(100) + leg.accel, seen_at(&segment, 5001).slope);
}

void test_a_falling_ramp_is_given_from_its_start_by_its_end(void)
{
    struct motion_leg leg = ramp(300, 100);
    motion_leg_set_end(&leg);

    struct step_segment segment = motion_leg_segment(&leg);

    TEST_ASSERT_EQUAL_HEX64(0, seen_at(&segment, 5000).residual);
    TEST_ASSERT_EQUAL_UINT64(slope_of(300), seen_at(&segment, 5000).slope);
    TEST_ASSERT_EQUAL_INT32(-1000 * (int32_t)STEP_ACCEL_PER_ACCEL, segment.accel);
}

void test_a_falling_ramp_that_starts_between_ticks_is_given_from_the_tick_before(void)
{
    struct motion_leg leg = ramp(300, 100);
    leg.start.fraction = HALF_TICK;
    motion_leg_set_end(&leg);

    struct step_segment segment = motion_leg_segment(&leg);

    TEST_ASSERT_EQUAL_HEX64(0U - (slope_of(300) / 2U + leg.accel / 4U), seen_at(&segment, 5000).residual);
    TEST_ASSERT_EQUAL_UINT64(slope_of(300) + leg.accel, seen_at(&segment, 5000).slope);
}

/* 16 000 s from V16000 to S1 with A1: the position of its start, seen back from the end, exceeds 64 bits. */
void test_the_longest_falling_ramp_wraps_without_loss(void)
{
    const uint64_t speeds = UINT64_C(16000) * 16000U - 1U;
    struct motion_leg leg = {
        .to = motion_place_add(0, speeds, 2),
        .from_slope = slope_of(16000),
        .to_slope = slope_of(1),
        .pulse_twice_speed2 = 2U * motion_square(16000),
        .accel = STEP_ACCEL_PER_ACCEL,
    };
    motion_leg_set_end(&leg);

    struct step_segment segment = motion_leg_segment(&leg);

    TEST_ASSERT_EQUAL_UINT64(UINT64_C(15999) * TICK_HZ, leg.end.ticks);
    TEST_ASSERT_EQUAL_HEX64(0, seen_at(&segment, 0).residual);
    TEST_ASSERT_EQUAL_UINT64(slope_of(16000), seen_at(&segment, 0).slope);
}

/* A step up reaches the square root of 100^2 + 2000, a step down that of 300^2 - 2000, by 1000 steps/s each second. */
void test_a_segment_of_a_ramp_stands_on_its_first_pulse_whatever_the_guess(void)
{
    for (uint32_t wrong = 0; wrong < 20; wrong += 5) {
        struct motion_leg up = ramp(100, 300);
        struct motion_leg down = ramp(300, 100);
        up.pulse_twice_speed2 = 2U * motion_square(101 + wrong);
        down.pulse_twice_speed2 = 2U * motion_square(299 - wrong);
        motion_leg_set_end(&up);
        motion_leg_set_end(&down);

        TEST_ASSERT_EQUAL_UINT32(5000 + 801739, motion_leg_segment(&up).tick);
        TEST_ASSERT_EQUAL_UINT32(5000 + 281573, motion_leg_segment(&down).tick);
    }
}

void test_only_a_cruise_has_a_pace(void)
{
    struct motion_leg even = cruise(999, 10);
    struct motion_leg rising = ramp(100, 300);
    motion_leg_set_end(&even);
    motion_leg_set_end(&rising);

    TEST_ASSERT_EQUAL_UINT32(TICK_HZ / 999U, motion_leg_segment(&even).pace_ticks);
    TEST_ASSERT_EQUAL_UINT32(0, motion_leg_segment(&rising).pace_ticks);
}

void test_a_new_segment_is_not_marked(void)
{
    struct motion_leg leg = cruise(1000, 10);
    motion_leg_set_end(&leg);

    TEST_ASSERT_FALSE(motion_leg_segment(&leg).marked);
}
