#include "unity.h"

#include "pos_frame.h"

static const struct pos_scale scale = {.steps = 1, .micrometres = 10};
static struct pos_frame frame;
static struct pos_target target;

void setUp(void)
{
    pos_frame_init(&frame, &scale, 0);
}

void tearDown(void)
{
}

static void follow(int64_t motor_steps)
{
    pos_frame_follow(&frame, motor_steps);
}

/* A way that is made at once. */
static void go(int32_t way_um)
{
    TEST_ASSERT_TRUE(pos_frame_may_aim(&frame, way_um));
    pos_frame_aim(&frame, way_um, &target);
    follow(target.step);
    pos_frame_reach(&frame, &target);
}

void test_remainders_are_carried_from_one_measure_to_the_next(void)
{
    for (unsigned i = 0; i < 10000; i++) {
        go(1);
    }
    TEST_ASSERT_EQUAL_INT64(1000, frame.step);
    for (unsigned i = 0; i < 3; i++) {
        go(-7);
    }
    TEST_ASSERT_EQUAL_INT64(998, frame.step);
}

void test_a_measure_that_is_given_up_elsewhere_begins_anew_on_the_step(void)
{
    go(4);
    follow(3);
    pos_frame_give_up(&frame);
    TEST_ASSERT_EQUAL_INT64(3, frame.base_step);
    TEST_ASSERT_EQUAL_INT64(0, frame.base_um);
    go(4);
    pos_frame_give_up(&frame);
    TEST_ASSERT_EQUAL_INT64(4, frame.base_um);
    go(1);
    TEST_ASSERT_EQUAL_INT64(4, frame.step);
}

void test_a_way_may_not_lead_out_of_what_can_be_counted(void)
{
    frame.base_um = POS_MEASURE_UM_MAX - 1;
    TEST_ASSERT_TRUE(pos_frame_may_aim(&frame, 1));
    TEST_ASSERT_FALSE(pos_frame_may_aim(&frame, 2));
    frame.base_um = 1 - POS_MEASURE_UM_MAX;
    TEST_ASSERT_TRUE(pos_frame_may_aim(&frame, -1));
    TEST_ASSERT_FALSE(pos_frame_may_aim(&frame, -2));
    pos_frame_aim(&frame, -1, &target);
    TEST_ASSERT_EQUAL_INT64(-461168601842738790, target.step);
}

/* What had been reached elsewhere is of no account, also that it was no whole step. */
void test_a_reference_is_where_the_next_measure_begins(void)
{
    go(4);
    pos_frame_refer(&frame, 7, 1000);
    TEST_ASSERT_EQUAL_INT64(7, frame.base_step);
    follow(7);
    pos_frame_give_up(&frame);
    TEST_ASSERT_EQUAL_INT64(7, frame.base_step);
    TEST_ASSERT_EQUAL_INT64(0, frame.base_um);
    go(14);
    TEST_ASSERT_EQUAL_INT64(8, frame.step);
}

void test_what_was_reached_from_a_reference_counts_from_there(void)
{
    pos_frame_refer(&frame, 100, -3);
    pos_frame_aim_at(&frame, 41, &target);
    TEST_ASSERT_EQUAL_INT64(104, target.step);
    follow(104);
    pos_frame_reach(&frame, &target);
    pos_frame_give_up(&frame);
    TEST_ASSERT_EQUAL_INT64(100, frame.base_step);
    TEST_ASSERT_EQUAL_INT64(44, frame.base_um);
    go(1);
    TEST_ASSERT_EQUAL_INT64(105, frame.step);
}

/* POS_MODE from elsewhere, then a position, which is counted from the reference. */
void test_what_is_reached_has_its_own_base(void)
{
    pos_frame_refer(&frame, 100, 0);
    follow(200);
    pos_frame_give_up(&frame);
    TEST_ASSERT_EQUAL_INT64(200, frame.base_step);
    pos_frame_aim_at(&frame, 500, &target);
    follow(target.step);
    pos_frame_reach(&frame, &target);
    TEST_ASSERT_EQUAL_INT64(100, frame.base_step);
    TEST_ASSERT_EQUAL_INT64(500, frame.base_um);
    go(0);
    TEST_ASSERT_EQUAL_INT64(150, frame.step);
}

void test_positions_count_from_the_reference(void)
{
    follow(12);
    pos_frame_refer(&frame, 10, -3);
    TEST_ASSERT_TRUE(frame.referenced);
    TEST_ASSERT_EQUAL_INT64(17, pos_frame_position_um(&frame, 12));
    pos_frame_aim_at(&frame, INT32_MAX, &target);
    TEST_ASSERT_EQUAL_INT64(10 + 214748365, target.step);
    pos_frame_aim_at(&frame, INT32_MIN, &target);
    TEST_ASSERT_EQUAL_INT64(10 - 214748364, target.step);
    TEST_ASSERT_EQUAL_INT64(INT64_C(3) + INT32_MIN, target.base_um);
    TEST_ASSERT_EQUAL_INT64(INT64_C(3) + INT32_MIN - 20, pos_frame_left_um(&frame, &target));
}

void test_another_scale_makes_the_present_place_zero(void)
{
    go(4);
    follow(50);
    pos_frame_refer(&frame, 40, 1000);
    frame.base_um = 4;
    pos_frame_reset(&frame, &(struct pos_scale){.steps = 500, .micrometres = 1}, 0, 50);
    TEST_ASSERT_FALSE(frame.referenced);
    TEST_ASSERT_EQUAL_INT64(50, frame.step);
    TEST_ASSERT_EQUAL_INT64(0, pos_frame_position_um(&frame, 50));
    TEST_ASSERT_EQUAL_INT64(50, frame.base_step);
    TEST_ASSERT_EQUAL_INT64(50, frame.zero_step);
    TEST_ASSERT_EQUAL_INT64(0, frame.base_um);
    go(-2);
    TEST_ASSERT_EQUAL_INT64(-950, frame.step);
}

/* ---- software limits ------------------------------------------------------------------------------------------- */

static void assert_limited(int64_t from, int32_t to_um, int64_t step, bool cut)
{
    frame.step = from;
    pos_frame_aim_at(&frame, to_um, &target);
    pos_frame_limit(&frame, &target, -500, 1234);
    TEST_ASSERT_EQUAL_INT64(step, target.step);
    TEST_ASSERT_EQUAL(cut, target.cut);
}

void test_a_measure_that_stays_inside_is_not_cut(void)
{
    assert_limited(0, 1230, 123, false);
    assert_limited(0, -500, -50, false);
    assert_limited(100, -500, -50, false);
    assert_limited(-50, 1230, 123, false);
    assert_limited(7, 70, 7, false);
}

void test_a_measure_is_cut_at_the_last_step_inside(void)
{
    assert_limited(0, 1240, 123, true);
    assert_limited(0, INT32_MAX, 123, true);
    assert_limited(0, -510, -50, true);
    assert_limited(0, INT32_MIN, -50, true);
    assert_limited(123, 2000, 123, true);
    assert_limited(-50, -2000, -50, true);
}

void test_software_limits_are_positions(void)
{
    pos_frame_refer(&frame, 10, 200);
    frame.step = 0;
    pos_frame_aim_at(&frame, 3000, &target);
    pos_frame_limit(&frame, &target, -500, 1234);
    TEST_ASSERT_EQUAL_INT64(113, target.step);
    pos_frame_aim_at(&frame, -3000, &target);
    pos_frame_limit(&frame, &target, -500, 1234);
    TEST_ASSERT_EQUAL_INT64(-60, target.step);
}

void test_who_is_outside_and_stays_is_not_cut(void)
{
    assert_limited(200, 2000, 200, false);
    assert_limited(-100, -1000, -100, false);
}

void test_who_is_outside_goes_inwards_as_far_as_he_was_told_and_not_outwards(void)
{
    assert_limited(200, 1900, 190, false);
    assert_limited(200, 2100, 200, true);
    assert_limited(200, -2000, -50, true);
    assert_limited(-100, -900, -90, false);
    assert_limited(-100, -1100, -100, true);
    assert_limited(-100, 3000, 123, true);
}

void test_what_is_left_of_a_measure_that_is_cut_ends_at_the_limit(void)
{
    frame.step = 100;
    frame.base_um = 1000;
    pos_frame_aim(&frame, 1000, &target);
    TEST_ASSERT_EQUAL_INT64(1000, pos_frame_left_um(&frame, &target));
    pos_frame_limit(&frame, &target, -500, 1234);
    TEST_ASSERT_EQUAL_INT64(230, pos_frame_left_um(&frame, &target));
}

void test_what_is_left_to_a_limit_counts_from_where_the_measure_does(void)
{
    follow(40);
    pos_frame_give_up(&frame);
    pos_frame_aim(&frame, 2000, &target);
    pos_frame_limit(&frame, &target, -500, 1234);
    TEST_ASSERT_EQUAL_INT64(830, pos_frame_left_um(&frame, &target));
    follow(123);
    TEST_ASSERT_EQUAL_INT64(0, pos_frame_left_um(&frame, &target));
}

/* ---- backlash -------------------------------------------------------------------------------------------------- */

static void assert_way(int64_t motor_steps, int64_t to, uint64_t pulses, bool backward)
{
    struct pos_way way = pos_frame_way(&frame, motor_steps, to);
    TEST_ASSERT_EQUAL_UINT64(pulses, way.pulses);
    TEST_ASSERT_EQUAL(backward, way.backward);
}

void test_without_backlash_a_way_is_its_steps(void)
{
    assert_way(0, 25, 25, false);
    assert_way(0, -25, 25, true);
    assert_way(0, 0, 0, false);
}

/* 55 um are 5.5 steps: 6. All slack is taken up forward at the start. */
void test_backlash_is_taken_up_where_the_direction_changes(void)
{
    pos_frame_init(&frame, &scale, 55);
    TEST_ASSERT_EQUAL_UINT32(6, frame.backlash);
    assert_way(0, 10, 10, false);
    assert_way(0, -10, 16, true);
    follow(-4);
    TEST_ASSERT_EQUAL_INT64(0, frame.step);
    assert_way(-4, 10, 14, false);
    assert_way(-4, -10, 12, true);
    assert_way(-4, 0, 0, false);
    follow(-16);
    TEST_ASSERT_EQUAL_INT64(-10, frame.step);
    assert_way(-16, -9, 7, false);
    assert_way(-16, -11, 1, true);
    TEST_ASSERT_EQUAL_INT64(-10, pos_frame_step_of(&frame, -10));
    TEST_ASSERT_EQUAL_INT64(-9, pos_frame_step_of(&frame, -9));
    follow(-9);
    TEST_ASSERT_EQUAL_INT64(-9, frame.step);
}

void test_another_backlash_takes_up_all_slack(void)
{
    pos_frame_init(&frame, &scale, 50);
    follow(-12);
    TEST_ASSERT_EQUAL_INT64(-7, frame.step);
    pos_frame_reset(&frame, &scale, 30, -12);
    assert_way(-12, -6, 1, false);
    assert_way(-12, -8, 4, true);
}

void test_the_same_backlash_in_steps_keeps_the_slack_that_there_is(void)
{
    static const struct pos_scale twice = {.steps = 2, .micrometres = 20};
    pos_frame_init(&frame, &scale, 50);
    follow(-12);
    pos_frame_reset(&frame, &twice, 50, -12);
    TEST_ASSERT_EQUAL_INT64(-7, frame.base_step);
    assert_way(-12, -6, 6, false);
    assert_way(-12, -8, 1, true);
}
