#include "motion_profile.h"
#include "step_scale.h"
#include "unity.h"

static struct motion_span span;

/* 1000 steps after step 50 with at most V1000, A1000, from 100 steps/s to 100. */
void setUp(void)
{
    span = (struct motion_span){
        .begin = 50,
        .steps = 1000,
        .enter_speed2 = motion_square(100),
        .exit_speed2 = motion_square(100),
        .speed_steps_per_s = 1000,
        .accel_steps_per_s2 = 1000,
        .start_speed_steps_per_s = 100,
    };
}

void tearDown(void)
{
}

static void assert_place(uint64_t step, uint64_t quanta, struct motion_place place)
{
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(step, place.step, "step");
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(quanta, place.quanta, "quanta");
}

/* Squares of the speeds, twice, as a profile has them. */
static void assert_speeds(const struct motion_profile *profile, uint64_t enter, uint64_t turn, uint64_t cruise,
                          uint64_t exit)
{
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(enter, profile->enter, "enter");
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(turn, profile->turn, "turn");
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(cruise, profile->cruise, "cruise");
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(exit, profile->exit, "exit");
}

void test_the_square_of_the_greatest_speed_fits(void)
{
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(160000000000), motion_square(MOTION_SPEED_MAX));
}

void test_the_gain_over_a_span_is_twice_acceleration_times_steps(void)
{
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(1920000000000), motion_gain(60000, 16000000));
}

void test_the_gain_is_limited_from_where_it_would_be_larger(void)
{
    const uint64_t most = UINT64_C(1) << 60;

    TEST_ASSERT_EQUAL_UINT64(most - 2U, motion_gain(1, (most >> 1U) - 1U));
    TEST_ASSERT_EQUAL_UINT64(most, motion_gain(1, most >> 1U));
    TEST_ASSERT_EQUAL_UINT64(most, motion_gain(1, (most >> 1U) + 1U));
    TEST_ASSERT_EQUAL_UINT64(most, motion_gain(STEP_ACCEL_MAX, UINT64_MAX));
}

/* 2^60 is no multiple of 6. */
void test_the_greatest_gain_below_the_limit_is_exact(void)
{
    const uint64_t most = UINT64_C(1) << 60;

    TEST_ASSERT_EQUAL_UINT64(most - 4U, motion_gain(3, most / 6U));
    TEST_ASSERT_EQUAL_UINT64(most, motion_gain(3, most / 6U + 1U));
}

void test_a_long_way_has_two_ramps_and_a_cruise(void)
{
    struct motion_profile profile = motion_profile_fit(&span);

    assert_speeds(&profile, 20000, 2000000, 2000000, 20000);
    assert_place(50 + 495, 0, profile.corner_a);
    assert_place(1050 - 495, 0, profile.corner_b);
    TEST_ASSERT_EQUAL_UINT64(50, profile.begin);
    TEST_ASSERT_EQUAL_UINT64(1050, profile.end);
    TEST_ASSERT_EQUAL_UINT32(1000, profile.accel_steps_per_s2);
}

void test_ramps_that_just_fit_meet_at_the_top_speed(void)
{
    span.steps = 990;

    struct motion_profile profile = motion_profile_fit(&span);

    TEST_ASSERT_EQUAL_UINT64(2000000, profile.turn);
    assert_place(50 + 495, 0, profile.corner_a);
    assert_place(50 + 495, 0, profile.corner_b);
}

void test_on_a_short_way_the_ramps_meet_below_the_top_speed(void)
{
    span.steps = 989;

    struct motion_profile profile = motion_profile_fit(&span);

    TEST_ASSERT_EQUAL_UINT64(2U * (10000U + 989000U), profile.turn);
    assert_place(50 + 494, STEP_QUANTA / 2U, profile.corner_a);
    assert_place(50 + 494, STEP_QUANTA / 2U, profile.corner_b);
}

void test_ramps_that_meet_at_half_a_square_lose_nothing(void)
{
    span.steps = 1;
    span.enter_speed2 = 100;
    span.exit_speed2 = 101;
    span.accel_steps_per_s2 = 1;

    struct motion_profile profile = motion_profile_fit(&span);

    TEST_ASSERT_EQUAL_UINT64(100 + 101 + 2, profile.turn);
}

void test_a_way_at_the_top_speed_throughout_has_no_ramps(void)
{
    span.speed_steps_per_s = 100;

    struct motion_profile profile = motion_profile_fit(&span);

    assert_speeds(&profile, 20000, 20000, 20000, 20000);
    assert_place(50, 0, profile.corner_a);
    assert_place(1050, 0, profile.corner_b);
}

void test_a_way_between_different_speeds_has_different_ramps(void)
{
    span.exit_speed2 = motion_square(500);

    struct motion_profile profile = motion_profile_fit(&span);

    assert_place(50 + 495, 0, profile.corner_a);
    assert_place(1050 - 375, 0, profile.corner_b);
}

void test_an_entry_above_the_top_speed_is_braked_first(void)
{
    span.enter_speed2 = motion_square(1200);

    struct motion_profile profile = motion_profile_fit(&span);

    assert_speeds(&profile, 2880000, 2000000, 2000000, 20000);
    assert_place(50 + 220, 0, profile.corner_a);
    assert_place(1050 - 495, 0, profile.corner_b);
}

void test_a_way_too_short_to_brake_to_the_top_speed_is_left_above_it(void)
{
    span.enter_speed2 = motion_square(1200);
    span.steps = 100;
    span.exit_speed2 = motion_square(1200) - 200000;

    struct motion_profile profile = motion_profile_fit(&span);

    assert_speeds(&profile, 2880000, 2480000, 2480000, 2480000);
    assert_place(150, 0, profile.corner_a);
    assert_place(150, 0, profile.corner_b);
}

void test_without_a_change_nothing_jumps(void)
{
    span.enter_speed2 = motion_square(50);

    TEST_ASSERT_EQUAL_UINT64(2500, motion_profile_enter(&span));
    TEST_ASSERT_EQUAL_UINT64(motion_square(1000), motion_profile_floor(&span));
}

void test_a_change_takes_speeds_up_to_S_at_once(void)
{
    span.jumps = true;
    span.enter_speed2 = motion_square(50);

    TEST_ASSERT_EQUAL_UINT64(motion_square(100), motion_profile_enter(&span));
}

void test_a_change_does_not_jump_above_the_new_speed(void)
{
    span.jumps = true;
    span.enter_speed2 = motion_square(50);
    span.speed_steps_per_s = 70;

    TEST_ASSERT_EQUAL_UINT64(motion_square(70), motion_profile_enter(&span));
}

void test_a_change_does_not_jump_to_what_cannot_be_braked(void)
{
    span.jumps = true;
    span.enter_speed2 = 10;
    span.exit_speed2 = 4;
    span.steps = 2;
    span.accel_steps_per_s2 = 3;

    TEST_ASSERT_EQUAL_UINT64(4 + 12, motion_profile_enter(&span));
}

void test_a_change_never_slows_down_by_its_jump_upward(void)
{
    span.jumps = true;
    span.enter_speed2 = motion_square(500);

    TEST_ASSERT_EQUAL_UINT64(motion_square(500), motion_profile_enter(&span));
}

void test_a_change_to_a_speed_below_S_is_taken_at_once_from_S(void)
{
    span.jumps = true;
    span.speed_steps_per_s = 30;

    TEST_ASSERT_EQUAL_UINT64(motion_square(30), motion_profile_enter(&span));
}

void test_a_change_to_a_speed_below_S_is_braked_to_from_above_S(void)
{
    span.jumps = true;
    span.speed_steps_per_s = 30;
    span.enter_speed2 = motion_square(100) + 1U;

    TEST_ASSERT_EQUAL_UINT64(motion_square(100) + 1U, motion_profile_enter(&span));
}

void test_the_speed_jumps_from_S_down_where_the_brake_has_reached_S(void)
{
    span.jumps = true;
    span.speed_steps_per_s = 30;
    span.enter_speed2 = motion_square(500);
    span.exit_speed2 = motion_square(30);

    struct motion_profile profile = motion_profile_fit(&span);

    assert_speeds(&profile, 500000, 20000, 1800, 1800);
    assert_place(50 + 120, 0, profile.corner_a);
    assert_place(1050, 0, profile.corner_b);
}

void test_the_floor_of_a_change_is_S_where_the_new_speed_is_lower(void)
{
    span.jumps = true;
    span.speed_steps_per_s = 30;
    TEST_ASSERT_EQUAL_UINT64(motion_square(100), motion_profile_floor(&span));

    span.speed_steps_per_s = 101;
    TEST_ASSERT_EQUAL_UINT64(motion_square(101), motion_profile_floor(&span));
}

void test_a_stop_is_one_ramp_and_ends_at_the_last_whole_step_on_it(void)
{
    span.enter_speed2 = motion_square(101);
    span.accel_steps_per_s2 = 40;

    struct motion_profile profile = motion_profile_fit_stop(&span);

    assert_speeds(&profile, 20402, 20000, 20000, 20000);
    assert_place(50 + 2, STEP_QUANTA / 80U * 41U, profile.corner_a);
    assert_place(50 + 2, STEP_QUANTA / 80U * 41U, profile.corner_b);
    TEST_ASSERT_EQUAL_UINT64(52, profile.end);
}
