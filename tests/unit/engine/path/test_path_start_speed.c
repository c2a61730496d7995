#include "path_look.h"
#include "path_rig.h"
#include "unity.h"

enum {
    TICKS = 1200
};

static struct path_rig rig;
static uint64_t ticks[TICKS];
static uint64_t back[PATH_AXES];
static struct path_place place;

static unsigned pulses(uint64_t until_tick)
{
    return rig_pulses(&rig, 0, until_tick, ticks, TICKS);
}

static uint64_t speed2_of(uint64_t steps_per_s)
{
    return steps_per_s * steps_per_s * PATH_SPEED_UNITS * PATH_SPEED_UNITS;
}

static void start(uint32_t start_speed)
{
    path_set_start_speed(&rig.path, start_speed * PATH_SPEED_UNITS);
    TEST_ASSERT_TRUE(path_start(&rig.path, 0));
}

static void change_at(uint64_t tick, bool stops)
{
    const struct path_wish wish = {.tick = tick, .patience_ticks = UINT64_MAX / 2U};
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    (void)pulses(place.entry.time.high + 2U);
    (void)rig_pulses(&rig, 1, place.entry.time.high + 2U, ticks, 0);
    TEST_ASSERT_TRUE(stops ? rig_stop(&rig, &place, back) : rig_change(&rig, &place, back));
}

void setUp(void)
{
    rig_init(&rig);
}

void tearDown(void)
{
}

/* From 1000 to 3000 steps/s with 10 000 steps/s^2: 400 steps, 0.2 s. */
void test_a_path_begins_and_ends_with_its_start_speed(void)
{
    (void)rig_add(&rig, 1000, 0, 3000, 10000);
    start(1000);
    TEST_ASSERT_EQUAL_UINT(1000, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(16800000, ticks[399]);
    TEST_ASSERT_EQUAL_UINT64(16800000 + 28000, ticks[400]);
    TEST_ASSERT_EQUAL_UINT64(16800000 + 5600000, ticks[599]);
    TEST_ASSERT_EQUAL_UINT64(2 * 16800000 + 5600000, ticks[999]);
}

void test_a_vector_slower_than_the_start_speed_has_its_own_speed_all_the_way(void)
{
    (void)rig_add(&rig, 10, 0, 500, 10000);
    start(1000);
    TEST_ASSERT_EQUAL_UINT(10, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(168000, ticks[0]);
    TEST_ASSERT_EQUAL_UINT64(1680000, ticks[9]);
}

/* The second vector is left with 100 at most, and entered with what brakes to that over a step: 142 steps/s. */
void test_a_path_begins_no_faster_than_what_follows_can_be_braked_to(void)
{
    (void)rig_add(&rig, 1, 0, 1000, 1);
    (void)rig_add(&rig, 1, 0, 1000, 5000);
    (void)rig_add(&rig, 10, 0, 100, 10000);
    start(1000);
    (void)pulses(1);
    TEST_ASSERT_EQUAL_UINT64(speed2_of(100) + UINT64_C(10000) * 65536, rig.ring[0].exit2);
    TEST_ASSERT_EQUAL_UINT64(rig.ring[0].exit2 + UINT64_C(2) * 65536, rig.ring[0].enter2);
}

void test_a_stop_rests_as_soon_as_the_start_speed_is_reached_and_goes_on_with_it(void)
{
    (void)rig_add(&rig, 1000, 0, 3000, 10000);
    start(1000);
    change_at(16800000 + 28000 * 50, true);
    TEST_ASSERT_EQUAL_UINT(400, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(2 * 16800000 + 28000 * 50, rig.path.rest.entry.time.high);
    TEST_ASSERT_TRUE(path_start(&rig.path, 100000000));
    TEST_ASSERT_EQUAL_UINT(150, pulses(UINT64_MAX));
    TEST_ASSERT_TRUE(ticks[0] > 100000000 + 83000);
    TEST_ASSERT_TRUE(ticks[0] < 100000000 + 84000);
}

void test_a_stop_of_what_is_no_faster_than_the_start_speed_rests_at_once(void)
{
    (void)rig_add(&rig, 1000, 0, 500, 10000);
    start(1000);
    change_at(168000 * 10, true);
    TEST_ASSERT_EQUAL_UINT(0, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(1680000, rig.path.rest.entry.time.high);
    struct path_wish wish = {.tick = 168000 * 10 + 1};
    TEST_ASSERT_FALSE(path_find(&rig.path, &wish, &place));
    wish.tick--;
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
}

/* 24 steps before a border at 0 it has 692.8 steps/s, and no leg is left of its course. */
void test_the_speed_where_a_path_rests_at_once_is_the_one_with_which_it_came(void)
{
    (void)rig_add(&rig, 1000, 0, 3000, 10000);
    struct path_vector after = rig_vector(1000, 0, 3000, 10000);
    after.border_speed = 0;
    TEST_ASSERT_TRUE(path_add(&rig.path, &after));
    start(1000);
    const struct path_wish wish = {.tick = 40300000};
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    (void)pulses(place.entry.time.high + 2U);
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(0, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(976 * path_section_grains_per_step(&rig.ring[0]), place.entry.place.low);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(480000) * 65536, place.entry.speed2);
    TEST_ASSERT_EQUAL_UINT32(177362, path_speed_at(&rig.path, 0, 976));
}

void test_a_stop_brakes_through_vectors_down_to_the_start_speed(void)
{
    (void)rig_add(&rig, 1000, 0, 3000, 10000);
    (void)rig_add(&rig, 1000, 0, 3000, 5000);
    start(1000);
    change_at(16800000 + 28000 * 400, true);
    /* 200 steps with 10 000, half of the way down in terms of squares, then 400 with 5000. */
    TEST_ASSERT_EQUAL_UINT(600, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.rest.section);
    TEST_ASSERT_EQUAL_UINT64(400 * path_section_grains_per_step(&rig.ring[1]), rig.path.rest.entry.place.low);
}

void test_a_change_takes_speeds_up_to_the_start_speed_at_once(void)
{
    (void)rig_add(&rig, 1000, 0, 100, 10000);
    start(1000);
    (void)pulses(8400000 + 2);
    rig_set_speed(&rig.path, 0, 1000 * PATH_SPEED_UNITS);
    change_at(8400000, false);
    TEST_ASSERT_EQUAL_UINT(990, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(8400000 + 84000, ticks[0]);
    TEST_ASSERT_EQUAL_UINT64(8400000 + 84000 * 990, ticks[989]);
}

/* Both axes turn at the border, y makes its first pulse at step 2 after it. */
static void start_with_turn(void)
{
    struct path_vector there = rig_vector(-1000, -500, 50000, 1000000);
    struct path_vector back_again = rig_vector(1000, 500, 50000, 1000000);
    (void)path_add(&rig.path, &there);
    (void)path_add(&rig.path, &back_again);
    start(200000);
    (void)pulses(1);
    rig_set_speed(&rig.path, 1, 200000 * PATH_SPEED_UNITS);
}

static void change_after_turn(uint64_t steps)
{
    change_at((1000 + steps) * 1680 - 10, false);
    TEST_ASSERT_EQUAL_UINT32(1, place.section);
    TEST_ASSERT_EQUAL_UINT64(steps * path_section_grains_per_step(&rig.ring[1]), place.entry.place.low);
}

void test_a_change_where_axes_turn_leaves_dir_its_time(void)
{
    start_with_turn();
    change_after_turn(0);
    TEST_ASSERT_EQUAL_UINT64(rig.ring[1].border2, rig.path.next.speed2);
    (void)pulses(UINT64_MAX);
    TEST_ASSERT_TRUE(ticks[0] >= 1000 * 1680 + RIG_TURN_US * TICKS_PER_US);
}

void test_a_change_before_the_first_pulse_of_an_axis_that_turned_leaves_dir_its_time(void)
{
    start_with_turn();
    change_after_turn(1);
    TEST_ASSERT_EQUAL_UINT64(rig.ring[1].border2, rig.path.next.speed2);
}

void test_a_change_after_the_first_pulses_of_axes_that_turned_takes_the_start_speed_at_once(void)
{
    start_with_turn();
    change_after_turn(2);
    TEST_ASSERT_EQUAL_UINT64(speed2_of(200000), rig.path.next.speed2);
}

void test_a_start_where_an_axis_turns_takes_the_start_speed_at_once(void)
{
    (void)rig_add(&rig, -10, 0, 1000, 10000);
    (void)rig_add(&rig, 10, 0, 1000, 10000);
    start(1000);
    change_at(84000 * 10 - 10, true);
    (void)pulses(UINT64_MAX);
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.rest.section);
    TEST_ASSERT_TRUE(path_start(&rig.path, 10000000));
    TEST_ASSERT_EQUAL_UINT64(speed2_of(1000), rig.path.next.speed2);
}

/* Down to 1000 over 400 steps, then 100 at once. */
void test_a_change_falls_from_the_start_speed_at_once(void)
{
    (void)rig_add(&rig, 1000, 0, 3000, 10000);
    start(1000);
    change_at(16800000 + 28000 * 50, false);
    rig_set_speed(&rig.path, 0, 100 * PATH_SPEED_UNITS);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(550, pulses(UINT64_MAX));
    uint64_t slow = 2 * 16800000 + 28000 * 50;
    TEST_ASSERT_EQUAL_UINT64(slow, ticks[399]);
    TEST_ASSERT_EQUAL_UINT64(slow + 840000, ticks[400]);
    TEST_ASSERT_EQUAL_UINT64(slow + 840000 * 150, ticks[549]);
}

void test_a_change_below_the_start_speed_falls_at_once_when_it_is_slow_already(void)
{
    (void)rig_add(&rig, 1000, 0, 900, 10000);
    start(1000);
    change_at(84000000 - 10, false);
    rig_set_speed(&rig.path, 0, 100 * PATH_SPEED_UNITS);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(100, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(84000000 + 840000, ticks[0]);
}

/* 50 steps before the border at 900 steps/s, no faster than the start speed: the brake alone would not be enough. */
void test_what_falls_at_once_is_not_too_fast_for_what_follows(void)
{
    (void)rig_add(&rig, 100, 0, 900, 10);
    (void)rig_add(&rig, 100, 0, 900, 10);
    start(1000);
    (void)pulses(1);
    rig_set_speed(&rig.path, 0, 100 * PATH_SPEED_UNITS);
    rig_set_speed(&rig.path, 1, 100 * PATH_SPEED_UNITS);
    change_at(UINT64_C(84000000) * 50 / 900 - 10, false);
    TEST_ASSERT_EQUAL_UINT(50 + 100, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(speed2_of(100), rig.ring[0].leave2);
    TEST_ASSERT_EQUAL_UINT64(speed2_of(100), rig.ring[1].enter2);
}

/* At the start speed, and down to 500 at once; over 50 steps that cannot be braked to 100. */
void test_what_falls_at_once_and_is_still_too_fast_brakes_from_there(void)
{
    (void)rig_add(&rig, 100, 0, 1000, 10);
    (void)rig_add(&rig, 20000, 0, 1000, 10);
    start(1000);
    (void)pulses(1);
    rig_set_speed(&rig.path, 0, 500 * PATH_SPEED_UNITS);
    rig_set_speed(&rig.path, 1, 100 * PATH_SPEED_UNITS);
    change_at(84000 * 50 - 10, false);
    TEST_ASSERT_EQUAL_UINT(50 + 20000, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64((500 * 500 - 2 * 10 * 50) * UINT64_C(65536), rig.ring[0].leave2);
    TEST_ASSERT_EQUAL_UINT64(rig.ring[0].leave2, rig.ring[1].enter2);
}

/* 5 steps/s faster than the start speed, which 50 steps do not brake away. */
void test_what_is_faster_than_the_start_speed_does_not_fall_at_once(void)
{
    (void)rig_add(&rig, 600, 0, 1005, 10);
    (void)rig_add(&rig, 60000, 0, 1005, 10);
    start(1000);
    (void)pulses(1);
    rig_set_speed(&rig.path, 0, 100 * PATH_SPEED_UNITS);
    rig_set_speed(&rig.path, 1, 100 * PATH_SPEED_UNITS);
    change_at(46074600, false);
    TEST_ASSERT_EQUAL_UINT64(550 * path_section_grains_per_step(&rig.ring[0]), place.entry.place.low);
    TEST_ASSERT_EQUAL_UINT(50 + 60000, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64((1005 * 1005 - 2 * 10 * 50) * UINT64_C(65536), rig.ring[0].leave2);
    TEST_ASSERT_EQUAL_UINT64(rig.ring[0].leave2, rig.ring[1].enter2);
}

void test_a_border_speed_without_a_turn_does_not_hold_back_the_start_speed(void)
{
    struct path_vector vector = rig_vector(100, 0, 1000, 10000);
    vector.border_speed = 10 * PATH_SPEED_UNITS;
    TEST_ASSERT_TRUE(path_add(&rig.path, &vector));
    start(1000);
    (void)pulses(1);
    TEST_ASSERT_EQUAL_UINT64(speed2_of(1000), rig.ring[0].enter2);
}

/* The second vector is slower than the start speed: nothing falls to it before it begins, and 500 steps/s are too fast
 * to be braked away over 50 steps. */
void test_what_is_too_fast_for_a_slower_vector_to_come_brakes_into_it(void)
{
    (void)rig_add(&rig, 100, 0, 500, 10);
    (void)rig_add(&rig, 20000, 0, 500, 10);
    start(1000);
    (void)pulses(1);
    rig_set_speed(&rig.path, 1, PATH_SPEED_UNITS);
    change_at(168000 * 50 - 10, false);
    TEST_ASSERT_EQUAL_UINT(50 + 20000, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64((500 * 500 - 2 * 10 * 50) * UINT64_C(65536), rig.ring[1].enter2);
}

void test_vectors_that_come_later_are_a_chain_of_their_own(void)
{
    (void)rig_add(&rig, 50, 0, 3000, 10000);
    (void)rig_add(&rig, 50, 0, 3000, 10000);
    start(1000);
    (void)pulses(1);
    (void)rig_add(&rig, 100, 0, 3000, 10000);
    TEST_ASSERT_EQUAL_UINT32(2, rig.path.known);
    TEST_ASSERT_FALSE(path_lags(&rig.path));
    change_at(2000000, false);
    TEST_ASSERT_TRUE(pulses(UINT64_MAX) < 100);
    TEST_ASSERT_FALSE(path_lags(&rig.path));
    TEST_ASSERT_TRUE(path_start(&rig.path, 100000000));
    TEST_ASSERT_EQUAL_UINT(100, pulses(UINT64_MAX));
}

/* From 3000 to 1000 steps/s in the 500 steps that are left: 8000 steps/s^2 at least. */
void test_a_stop_with_its_own_acceleration_may_rest_at_the_start_speed(void)
{
    (void)rig_add(&rig, 1000, 0, 3000, 10000);
    start(1000);
    (void)pulses(UINT64_MAX);
    const struct path_vector slow = rig_vector(1000, 0, 500, 10000);
    TEST_ASSERT_TRUE(path_add(&rig.path, &slow));
    struct path_wish wish = {.tick = 16800000 + 28000 * 100, .patience_ticks = UINT64_MAX / 2U};
    wish.accel = 8100 * STEP_ACCEL_PER_ACCEL;
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    TEST_ASSERT_TRUE(path_can_rest(&rig.path, &place));
    wish.accel = 7900 * STEP_ACCEL_PER_ACCEL;
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    TEST_ASSERT_FALSE(path_can_rest(&rig.path, &place));
}

void test_vectors_that_come_later_and_go_straight_on_join(void)
{
    struct path_vector vector = rig_vector(1000, 0, 3000, 10000);
    (void)rig_add(&rig, 1000, 0, 3000, 10000);
    start(1000);
    vector.straight = true;
    TEST_ASSERT_TRUE(path_add(&rig.path, &vector));
    TEST_ASSERT_EQUAL_UINT32(2, rig.path.known);
    TEST_ASSERT_EQUAL_UINT(2000, pulses(UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(speed2_of(3000), rig.ring[1].enter2);
}

/* An axis would turn there at the start speed. */
void test_what_goes_straight_on_after_a_vector_that_waits_waits_too(void)
{
    struct path_vector vector = rig_vector(-1000, 0, 3000, 10000);
    (void)rig_add(&rig, 1000, 0, 3000, 10000);
    start(1000);
    TEST_ASSERT_TRUE(path_add(&rig.path, &vector));
    vector.straight = true;
    TEST_ASSERT_TRUE(path_add(&rig.path, &vector));
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.known);
    TEST_ASSERT_EQUAL_UINT(1000, pulses(UINT64_MAX));
    TEST_ASSERT_TRUE(path_start(&rig.path, UINT64_C(1) << 32U));
    TEST_ASSERT_EQUAL_UINT(2000, pulses(UINT64_MAX));
}

void test_vectors_that_have_joined_are_part_of_what_is_planned_anew(void)
{
    struct path_vector vector = rig_vector(1000, 0, 3000, 10000);
    (void)rig_add(&rig, 1000, 0, 3000, 10000);
    start(1000);
    vector.straight = true;
    TEST_ASSERT_TRUE(path_add(&rig.path, &vector));
    change_at(16800000 + 28000 * 50, false);
    TEST_ASSERT_EQUAL_UINT(2000 - 450, pulses(UINT64_MAX));
}

/* y has made its last pulse long ago, and DIR has had its time. */
void test_a_start_at_a_border_does_not_mind_a_turn_that_would_be_too_fast_for_a_path_that_moves(void)
{
    struct path_vector there = rig_vector(-1000, -500, 50000, 1000000);
    struct path_vector back_again = rig_vector(1000, 500, 200000, 1000000);
    (void)path_add(&rig.path, &there);
    (void)path_add(&rig.path, &back_again);
    TEST_ASSERT_TRUE(rig.ring[1].border2 < speed2_of(200000));
    start(200000);
    change_at(1000 * 1680 - 10, true);
    (void)pulses(UINT64_MAX);
    (void)rig_pulses(&rig, 1, UINT64_MAX, ticks, 0);
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.rest.section);
    TEST_ASSERT_TRUE(path_start(&rig.path, 10000000));
    TEST_ASSERT_EQUAL_UINT64(speed2_of(200000), rig.path.next.speed2);
}
