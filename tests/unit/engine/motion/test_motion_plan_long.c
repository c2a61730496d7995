#include "base_tick.h"
#include "plan_rig.h"
#include "segment_view.h"
#include "step_scale.h"
#include "unity.h"

/* Runs beyond what a segment counts. */

void setUp(void)
{
}

void tearDown(void)
{
}

enum {
    PIECE = 1 << 30
};

void test_a_run_without_end_comes_in_pieces(void)
{
    begin(order_endless(100, 1000, 2000));

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
    begin(order_endless(16000, 16000, 2000));

    (void)take_segments();

    TEST_ASSERT_EQUAL_UINT(SEGMENTS_MAX, count);
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_UINT32((uint32_t)(1000U + UINT64_C(5250) * (PIECE * i + 1U)), segments[i].tick);
        TEST_ASSERT_EQUAL_UINT64(0, segments[i].residual);
    }
}

/* 84 MHz / 15999 is no whole number; a piece loses less than 2^-32 tick, and its first pulse is on the nearest one. */
void test_pieces_off_the_tick_do_not_drift(void)
{
    begin(order_endless(15999, 15999, 2000));

    (void)take_segments();

    TEST_ASSERT_EQUAL_UINT(SEGMENTS_MAX, count);
    for (uint64_t i = 0; i < count; i++) {
        uint64_t pulses = i * PIECE + 1U;
        uint64_t ticks = pulses / 15999U * TICK_HZ + (pulses % 15999U * TICK_HZ + 15999U / 2U) / 15999U;
        TEST_ASSERT_EQUAL_UINT32((uint32_t)(1000U + ticks), segments[i].tick);
    }
}

/* Ramps of 247.5 steps and 0.45 s, and between them 2^30 steps at 84 000 ticks. */
void test_a_cruise_of_just_a_piece_ends_between_steps_where_its_ramp_begins(void)
{
    begin(order_single(PIECE + 495U, 100, 1000, 2000));

    TEST_ASSERT_EQUAL_UINT64(PIECE + 495U, take_segments());

    TEST_ASSERT_EQUAL_UINT(3, count);
    assert_segment(1, PIECE, 0);
    uint32_t corner = (uint32_t)(PLAN_START + 450 * TICKS_PER_MS + UINT64_C(84000) * PIECE);
    TEST_ASSERT_EQUAL_UINT64(STEP_QUANTA / 2U, seen_at(&segments[2], corner).residual);
    TEST_ASSERT_EQUAL_UINT64(1000U * STEP_SLOPE_PER_SPEED, seen_at(&segments[2], corner).slope);
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
    begin(order_endless(100, 1000, 1000));

    TEST_ASSERT_TRUE(stop_at((UINT64_C(1) << 33) + 5U, 1000000));

    TEST_ASSERT_EQUAL_UINT64(495, take_segments());
}

void test_a_run_without_end_is_changed_far_from_its_start(void)
{
    begin(order_endless(100, 1000, 1000));

    TEST_ASSERT_TRUE(change_at((UINT64_C(1) << 33) + 5U, 1000000, 900));

    (void)take_segments();
    assert_segment(0, 95, -1);
    assert_segment(1, PIECE, 0);
}
