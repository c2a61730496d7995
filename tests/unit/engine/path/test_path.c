#include "path_look.h"
#include "path_rig.h"
#include "unity.h"

enum {
    TICKS = 400
};

static struct path_rig rig;
static uint64_t ticks[TICKS];

static unsigned pulses(unsigned axis, uint64_t until_tick)
{
    return rig_pulses(&rig, axis, until_tick, ticks, TICKS);
}

static uint64_t exit2(uint32_t section)
{
    return rig.ring[section].exit2;
}

static uint64_t speed2_of(uint64_t steps_per_s)
{
    return steps_per_s * steps_per_s * PATH_SPEED_UNITS * PATH_SPEED_UNITS;
}

void setUp(void)
{
    rig_init(&rig);
}

void tearDown(void)
{
}

void test_an_empty_path_has_nothing_to_start(void)
{
    struct path_segment segment;
    TEST_ASSERT_FALSE(path_start(&rig.path, 1000));
    TEST_ASSERT_FALSE(path_next(&rig.path, 0, UINT64_MAX, &segment));
    TEST_ASSERT_TRUE(path_is_laid(&rig.path));
}

void test_a_ring_takes_as_many_vectors_as_it_has_places(void)
{
    for (unsigned i = 0; i < RIG_RING; i++) {
        TEST_ASSERT_TRUE(rig_add(&rig, 1, 1, 100, 100));
    }
    TEST_ASSERT_FALSE(rig_add(&rig, 1, 1, 100, 100));
    path_drop(&rig.path, 1);
    TEST_ASSERT_TRUE(rig_add(&rig, 1, 1, 100, 100));
}

void test_an_axis_that_rested_where_a_vector_was_dropped_has_the_pulses_of_those_after_it_alone(void)
{
    const unsigned dropped = 4;
    for (unsigned axis = 0; axis < 2; axis++) {
        rig_init(&rig);
        for (unsigned i = 0; i < RIG_RING; i++) {
            int32_t few = i == 0 ? 5 : 0;
            (void)rig_add(&rig, axis == 0 ? few : 100, axis == 1 ? few : 100, 10000, 1000000);
        }
        (void)path_start(&rig.path, 0);
        TEST_ASSERT_EQUAL_UINT(5, pulses(axis, 1000000));
        TEST_ASSERT_GREATER_THAN_UINT(dropped * 100U, pulses(1U - axis, 6000000));
        path_drop(&rig.path, dropped);
        for (unsigned i = 0; i < dropped; i++) {
            TEST_ASSERT_TRUE(rig_add(&rig, axis == 0 ? 50 : 100, axis == 1 ? 50 : 100, 10000, 1000000));
        }
        TEST_ASSERT_EQUAL_UINT(dropped * 50U, pulses(axis, UINT64_MAX));
    }
}

void test_pulses_of_a_dropped_vector_that_were_not_handed_over_still_come(void)
{
    for (unsigned i = 0; i < RIG_RING; i++) {
        (void)rig_add(&rig, 100, 5, 10000, 1000000);
    }
    (void)path_start(&rig.path, 0);
    (void)pulses(0, UINT64_MAX);
    path_drop(&rig.path, RIG_RING / 2);
    TEST_ASSERT_EQUAL_UINT(RIG_RING * 5U, pulses(1, UINT64_MAX));
}

void test_the_last_pulse_of_a_dropped_vector_that_was_not_handed_over_still_comes(void)
{
    struct path_segment next;
    (void)rig_add(&rig, 100, 1, 10000, 1000000);
    (void)rig_add(&rig, 100, 1, 10000, 1000000);
    (void)path_start(&rig.path, 0);
    (void)pulses(0, UINT64_MAX);
    path_drop(&rig.path, 1);
    TEST_ASSERT_TRUE(path_next(&rig.path, 1, UINT64_MAX, &next));
    TEST_ASSERT_TRUE(next.tick < rig.ring[1].entered.high + 2U);
    TEST_ASSERT_EQUAL_UINT(1, pulses(1, UINT64_MAX));
}

/* Both axes make the same steps; axis 1 has made those of the first vector and has not been asked for more. */
void test_an_axis_goes_on_after_a_dropped_vector_on_its_ticks(void)
{
    struct path_segment next;
    uint32_t made = 0;
    (void)rig_add(&rig, 100, 100, 10000, 1000000);
    (void)rig_add(&rig, 100, 100, 10000, 1000000);
    (void)path_start(&rig.path, 0);
    TEST_ASSERT_EQUAL_UINT(200, pulses(0, UINT64_MAX));
    const uint64_t expected[] = {ticks[100], ticks[199]};
    while (made < 100 && path_next(&rig.path, 1, UINT64_MAX, &next)) {
        made += next.segment.steps;
    }
    TEST_ASSERT_EQUAL_UINT32(100, made);
    path_drop(&rig.path, 1);
    TEST_ASSERT_EQUAL_UINT(100, pulses(1, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(expected[0], ticks[0]);
    TEST_ASSERT_EQUAL_UINT64(expected[1], ticks[99]);
}

void test_where_all_has_been_dropped_no_axis_has_anything_left(void)
{
    (void)rig_add(&rig, 100, 0, 10000, 1000000);
    (void)path_start(&rig.path, 0);
    TEST_ASSERT_EQUAL_UINT(100, pulses(0, UINT64_MAX));
    path_drop(&rig.path, 1);
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        TEST_ASSERT_EQUAL_UINT(0, pulses(axis, UINT64_MAX));
    }
    (void)rig_add(&rig, 50, 20, 10000, 1000000);
    TEST_ASSERT_TRUE(path_start(&rig.path, 100000000));
    TEST_ASSERT_EQUAL_UINT(50, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT(20, pulses(1, UINT64_MAX));
}

void test_the_speed_in_a_vector_that_is_not_laid_is_0_also_where_others_have_been_dropped(void)
{
    for (unsigned i = 0; i < 4; i++) {
        (void)rig_add(&rig, 100, 0, 10000, 1000000);
    }
    (void)path_start(&rig.path, 0);
    TEST_ASSERT_GREATER_THAN_UINT(100, pulses(0, 1500000));
    path_drop(&rig.path, 1);
    TEST_ASSERT_EQUAL_UINT32(2, rig.path.laid);
    TEST_ASSERT_EQUAL_UINT32(10000 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 1, 50));
    TEST_ASSERT_EQUAL_UINT32(0, path_speed_at(&rig.path, 2, 50));
}

/* 1000 steps with 426 667/256 steps/s and 50 000 steps/s^2. */
void test_a_vector_of_one_axis_has_its_pulses_where_they_are_known_to_be(void)
{
    struct path_vector vector = rig_vector(1000, 0, 1, 50000);
    vector.speed = 426667;
    (void)path_add(&rig.path, &vector);
    TEST_ASSERT_TRUE(path_start(&rig.path, 0));
    uint64_t all[1000];
    TEST_ASSERT_EQUAL_UINT(1000, rig_pulses(&rig, 0, UINT64_MAX, all, 1000));
    TEST_ASSERT_EQUAL_UINT64(531263, all[0]);
    TEST_ASSERT_EQUAL_UINT64(751319, all[1]);
    TEST_ASSERT_EQUAL_UINT64(2811200, all[27]);
    TEST_ASSERT_EQUAL_UINT64(52668700, all[998]);
    TEST_ASSERT_EQUAL_UINT64(53199963, all[999]);
}

void test_all_axes_end_together_at_the_border(void)
{
    (void)rig_add(&rig, 100, -37, 10000, 1000000);
    (void)path_start(&rig.path, 7);
    TEST_ASSERT_EQUAL_UINT(100, pulses(0, UINT64_MAX));
    uint64_t last = ticks[99];
    TEST_ASSERT_EQUAL_UINT(37, pulses(1, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(last, ticks[36]);
    TEST_ASSERT_EQUAL_UINT(0, pulses(2, UINT64_MAX));
}

/* 2^31 - 1 steps with the most acceleration: more than any speed could gain. */
void test_the_longest_way_is_enough_for_any_speed(void)
{
    (void)rig_add(&rig, INT32_MAX, 1, STEP_SPEED_MAX, STEP_ACCEL_MAX);
    (void)rig_add(&rig, INT32_MAX, 1, STEP_SPEED_MAX, STEP_ACCEL_MAX);
    (void)path_start(&rig.path, 0);
    (void)pulses(1, 1);
    TEST_ASSERT_EQUAL_UINT64(speed2_of(STEP_SPEED_MAX), exit2(0));
    TEST_ASSERT_EQUAL_UINT64(speed2_of(STEP_SPEED_MAX) * 2U, rig.path.kept[0].course.leg[1].twice_speed2);
}

void test_a_segment_tells_its_direction_and_its_time(void)
{
    struct path_segment segment;
    const uint64_t late = (UINT64_C(1) << 40) + 5U;
    (void)rig_add(&rig, 100, -37, 10000, 1000000);
    (void)path_start(&rig.path, late);
    TEST_ASSERT_TRUE(path_next(&rig.path, 0, UINT64_MAX, &segment));
    TEST_ASSERT_FALSE(segment.backward);
    TEST_ASSERT_EQUAL_UINT64(late + 118794, segment.tick);
    TEST_ASSERT_EQUAL_UINT32((uint32_t)segment.tick, segment.segment.tick);
    TEST_ASSERT_TRUE(path_next(&rig.path, 1, UINT64_MAX, &segment));
    TEST_ASSERT_TRUE(segment.backward);
}

void test_what_begins_later_than_wanted_is_not_handed_over(void)
{
    struct path_segment segment;
    (void)rig_add(&rig, 100, 1, 10000, 1000000);
    (void)rig_add(&rig, 100, 1, 10000, 1000000);
    (void)path_start(&rig.path, 0);
    TEST_ASSERT_FALSE(path_next(&rig.path, 0, 118794, &segment));
    TEST_ASSERT_TRUE(path_next(&rig.path, 0, 118795, &segment));
    TEST_ASSERT_EQUAL_UINT32(50, segment.segment.steps);
    TEST_ASSERT_EQUAL_UINT(50, pulses(0, 1200000));
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.laid);
    TEST_ASSERT_EQUAL_UINT(100, pulses(0, 5000000));
    TEST_ASSERT_EQUAL_UINT32(2, rig.path.laid);
}

void test_a_vector_that_begins_at_the_tick_up_to_which_is_asked_is_not_laid(void)
{
    (void)rig_add(&rig, 100, 0, 10000, 1000000);
    (void)rig_add(&rig, 100, 0, 10000, 1000000);
    (void)path_start(&rig.path, 0);
    (void)pulses(0, 1);
    const uint64_t border = rig.path.next.time.high;
    (void)pulses(0, border);
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.laid);
    (void)pulses(0, border + 1U);
    TEST_ASSERT_EQUAL_UINT32(2, rig.path.laid);
}

void test_only_an_axis_that_has_had_steps_need_be_asked(void)
{
    (void)rig_add(&rig, 0, -5, 1000, 10000);
    TEST_ASSERT_FALSE(path_moves(&rig.path, 0));
    TEST_ASSERT_TRUE(path_moves(&rig.path, 1));
    TEST_ASSERT_FALSE(path_moves(&rig.path, 2));
    (void)rig_add(&rig, 5, 0, 1000, 10000);
    TEST_ASSERT_TRUE(path_moves(&rig.path, 0));
    TEST_ASSERT_TRUE(path_moves(&rig.path, 1));
}

void test_borders_are_as_fast_as_the_vectors_and_the_border_speed_allow(void)
{
    (void)rig_add(&rig, 1000, 0, 2000, 10000);
    (void)rig_add(&rig, 1000, 0, 3000, 10000);
    struct path_vector slow = rig_vector(1000, 0, 3000, 10000);
    slow.border_speed = 700 * PATH_SPEED_UNITS;
    (void)path_add(&rig.path, &slow);
    (void)path_start(&rig.path, 0);
    TEST_ASSERT_EQUAL_UINT64(speed2_of(2000), exit2(0));
    TEST_ASSERT_EQUAL_UINT64(speed2_of(700), exit2(1));
    TEST_ASSERT_EQUAL_UINT64(0, exit2(2));
}

void test_borders_can_be_braked_from_and_reached(void)
{
    (void)rig_add(&rig, 2, 0, 100000, 10000);
    (void)rig_add(&rig, 1000, 0, 100000, 10000);
    (void)rig_add(&rig, 8, 0, 100000, 10000);
    (void)path_start(&rig.path, 0);
    TEST_ASSERT_EQUAL_UINT64(speed2_of(200), exit2(0));
    TEST_ASSERT_EQUAL_UINT64(speed2_of(400), exit2(1));
}

void test_after_a_stand_between_vectors_the_path_goes_on_by_itself(void)
{
    (void)rig_add(&rig, 10, 3, 1000, 100000);
    struct path_vector stand = rig_vector(10, 3, 1000, 100000);
    stand.border_speed = 0;
    (void)path_add(&rig.path, &stand);
    (void)path_start(&rig.path, 0);
    TEST_ASSERT_EQUAL_UINT(20, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(2U * ticks[9], ticks[19]);
}

void test_a_vector_joins_by_itself_what_has_not_been_laid(void)
{
    (void)rig_add(&rig, 1000, 0, 1000, 10000);
    (void)rig_add(&rig, 1000, 0, 1000, 10000);
    (void)path_start(&rig.path, 0);
    (void)pulses(0, 10000);
    (void)rig_add(&rig, 1000, 0, 1000, 10000);
    TEST_ASSERT_FALSE(path_lags(&rig.path));
    (void)pulses(0, 100000000);
    TEST_ASSERT_EQUAL_UINT64(speed2_of(1000), exit2(1));
}

void test_a_path_that_has_been_laid_to_its_end_lags_when_a_vector_comes(void)
{
    (void)rig_add(&rig, 1000, 0, 1000, 10000);
    (void)path_start(&rig.path, 0);
    (void)pulses(0, 10000000);
    TEST_ASSERT_FALSE(path_lags(&rig.path));
    (void)rig_add(&rig, 1000, 0, 1000, 10000);
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.known);
    TEST_ASSERT_TRUE(path_lags(&rig.path));
}

void test_a_path_that_was_held_back_by_its_end_lags_when_a_vector_comes(void)
{
    (void)rig_add(&rig, 1000, 0, 10000, 10000);
    (void)rig_add(&rig, 5, 0, 10000, 10000);
    (void)path_start(&rig.path, 0);
    (void)pulses(0, 10000000);
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.laid);
    TEST_ASSERT_FALSE(path_lags(&rig.path));
    (void)rig_add(&rig, 1000, 0, 10000, 10000);
    TEST_ASSERT_TRUE(path_lags(&rig.path));
}

void test_a_path_that_was_held_back_by_a_vector_does_not_lag(void)
{
    (void)rig_add(&rig, 5, 0, 10000, 10000);
    (void)rig_add(&rig, 1000, 0, 10000, 10000);
    (void)path_start(&rig.path, 0);
    (void)pulses(0, 1);
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.laid);
    (void)rig_add(&rig, 1000, 0, 10000, 10000);
    TEST_ASSERT_FALSE(path_lags(&rig.path));
}

void test_a_chain_that_has_ended_is_followed_by_another_one(void)
{
    (void)rig_add(&rig, 100, 0, 1000, 10000);
    (void)path_start(&rig.path, 0);
    TEST_ASSERT_EQUAL_UINT(100, pulses(0, UINT64_MAX));
    TEST_ASSERT_FALSE(path_start(&rig.path, 99999999));
    (void)rig_add(&rig, 50, 0, 1000, 10000);
    TEST_ASSERT_TRUE(path_start(&rig.path, 99999999));
    TEST_ASSERT_EQUAL_UINT(50, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(99999999 + 1187939, ticks[0]);
}

/* Axis 1 has rested for 40 s, which its interval must not be taken for. All of the last vector is its brake. */
void test_a_brake_after_a_long_rest_has_its_pulses_on_their_ticks(void)
{
    const uint64_t late_tick = UINT64_C(3360000000);
    (void)rig_add(&rig, 100, 100, 1000, 100000);
    (void)rig_add(&rig, 40000, 0, 1000, 100000);
    (void)rig_add(&rig, 50, 50, 1000, 10000);
    (void)path_start(&rig.path, 0);
    TEST_ASSERT_EQUAL_UINT(40100, pulses(0, late_tick));
    TEST_ASSERT_EQUAL_UINT(50, pulses(0, UINT64_MAX));
    uint64_t expected[50];
    for (unsigned i = 0; i < 50; i++) {
        expected[i] = ticks[i];
    }
    struct path_segment next;
    struct step_generator generator = {0};
    for (unsigned made = 0; path_next(&rig.path, 1, UINT64_MAX, &next);) {
        step_generator_load(&generator, &next.segment);
        for (uint32_t i = 0; i < next.segment.steps; i++, made++) {
            uint32_t tick = i == 0 ? generator.tick : step_generator_next(&generator);
            TEST_ASSERT_TRUE(made < 100 || tick == (uint32_t)expected[made - 100]);
        }
    }
    TEST_ASSERT_EQUAL_UINT32((uint32_t)expected[49], generator.tick);
}

/* What has been laid and forgotten is laid again for an axis that comes later. */
void test_axes_may_be_handed_over_one_after_the_other(void)
{
    for (unsigned i = 0; i < 6; i++) {
        (void)rig_add(&rig, 50, 21, 1000 + 100 * i, 100000);
    }
    (void)path_start(&rig.path, 0);
    TEST_ASSERT_EQUAL_UINT(300, pulses(0, UINT64_MAX));
    uint64_t last = ticks[299];
    TEST_ASSERT_EQUAL_UINT(126, pulses(1, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(last, ticks[125]);
}

void test_an_axis_turns_where_its_border_speed_gives_it_time(void)
{
    (void)rig_add(&rig, 1000, 1000, 200000, 8000000);
    (void)rig_add(&rig, 1000, -1000, 200000, 8000000);
    (void)path_start(&rig.path, 0);
    uint64_t gap[2] = {0};
    struct path_segment segment;
    while (path_next(&rig.path, 1, UINT64_MAX, &segment)) {
        if (segment.backward && gap[1] == 0) {
            gap[1] = segment.tick;
        }
    }
    gap[0] = rig.ring[1].entered.high;
    TEST_ASSERT_TRUE(gap[1] - gap[0] >= RIG_TURN_US * TICKS_PER_US);
    TEST_ASSERT_TRUE(gap[1] - gap[0] < 2U * RIG_TURN_US * TICKS_PER_US);
}
