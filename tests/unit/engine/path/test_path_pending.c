/* Where a path is changed again while a change is yet to come, or on a ramp between two steps that are far apart. */
#include "path_lay.h"
#include "path_look.h"
#include "path_rig.h"
#include "unity.h"

enum {
    START = 1000,
    PATIENCE = 42000,
    EARLY = PATH_EARLY_US_MAX * 84,
    STEP_TICKS = 8400000, /* of the cruise */
    UP_TICKS = 84000,     /* and its ramp, in which it goes 1/200 step */
};

static struct path_rig rig;
static struct path_kept before;
static uint64_t back[PATH_AXES];
static struct path_place place;

static void begin(void)
{
    rig_init(&rig);
    path_set_before(&rig.path, &before);
}

/* 10 steps/s, with ramps of a millisecond. */
void setUp(void)
{
    begin();
    (void)rig_add(&rig, 100, 33, 10, 10000);
}

void tearDown(void)
{
}

static void hand_over(uint64_t until_tick)
{
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        (void)rig_pulses(&rig, axis, until_tick, NULL, 0);
    }
}

static void start(void)
{
    TEST_ASSERT_TRUE(path_start(&rig.path, START));
    hand_over(UINT64_MAX);
}

/* A path of its own with a slow ramp; and when it comes to a step on it. */
static void start_ramp(int32_t steps, uint32_t accel)
{
    begin();
    (void)rig_add(&rig, steps, 0, 100000, accel);
    start();
}

static uint64_t ramp_tick(uint32_t step)
{
    TEST_ASSERT_TRUE(rig.path.laid > 0);
    return path_course_step(&rig.path.kept[0].course, step).time.high;
}

static bool find(uint64_t tick, uint64_t patience_ticks, uint64_t early_ticks)
{
    const struct path_wish wish = {.tick = tick, .patience_ticks = patience_ticks, .early_ticks = early_ticks};
    return path_find(&rig.path, &wish, &place);
}

static void assert_at_step(uint32_t step)
{
    uint64_t grains = path_section_grains_per_step(path_section_of(&rig.path, place.section));
    TEST_ASSERT_EQUAL_UINT64(step * grains, place.entry.place.low);
}

/* Another speed from a place on. */
static void change(uint32_t speed)
{
    rig_set_speed(&rig.path, 0, speed * PATH_SPEED_UNITS);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    hand_over(UINT64_MAX);
}

/* A change at step 1, which is found while the path speeds up to the cruise before it. */
static void change_at_first_step(void)
{
    start();
    TEST_ASSERT_TRUE(find(START + UP_TICKS / 2, UINT64_MAX / 2U, 0));
    assert_at_step(1);
    change(20);
}

/* ---- while one is pending -------------------------------------------------------------------------------------- */

void test_a_change_in_a_cruise_does_not_wait_for_one_that_is_pending_at_a_far_step(void)
{
    change_at_first_step();
    TEST_ASSERT_TRUE(find(START + 500000, PATIENCE, 0));
    TEST_ASSERT_UINT64_WITHIN(2, START + 500000, place.entry.time.high);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(2560) * 2560U, place.entry.speed2);
    uint64_t tick = path_course_step(&before.course, 1).time.high;
    change(20);
    TEST_ASSERT_TRUE(path_lay_course(&rig.path, 0)->leg[0].time.high < tick);
    TEST_ASSERT_TRUE(path_course_step(path_lay_course(&rig.path, 0), 1).time.high < tick - STEP_TICKS / 4);
}

void test_a_change_waits_for_one_that_is_pending_at_a_near_step(void)
{
    change_at_first_step();
    uint64_t tick = rig.path.origin.entry.time.high;
    TEST_ASSERT_TRUE(find(tick - PATIENCE, PATIENCE + 1, 0));
    assert_at_step(1);
    TEST_ASSERT_TRUE(find(tick - PATIENCE, PATIENCE - 100, 0));
    TEST_ASSERT_TRUE(place.entry.time.high < tick - PATIENCE + 10);
}

void test_a_change_on_a_ramp_waits_for_one_that_is_pending(void)
{
    start_ramp(1000, 100);
    uint64_t tick = ramp_tick(1);
    TEST_ASSERT_TRUE(find(tick + 10, PATIENCE, 0));
    change(1000);
    TEST_ASSERT_TRUE(find(tick + 100, PATIENCE, 0));
    assert_at_step(2);
}

void test_a_stop_that_stands_at_once_at_a_far_step_is_taken_back_in_the_cruise(void)
{
    path_set_start_speed(&rig.path, 20 * PATH_SPEED_UNITS);
    start();
    TEST_ASSERT_TRUE(find(START + 100, UINT64_MAX / 2U, 0));
    assert_at_step(1);
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    hand_over(UINT64_MAX);
    TEST_ASSERT_TRUE(find(START + 500000, UINT64_MAX / 2U, 0));
    assert_at_step(1);
    TEST_ASSERT_FALSE(find(rig.path.origin.entry.time.high + 1U, UINT64_MAX / 2U, 0));
}

/* ---- on a ramp, a step before the wish ------------------------------------------------------------------------- */

void test_on_a_slow_ramp_a_step_is_taken_that_is_due_a_little_before_the_wish(void)
{
    start_ramp(1000, 100);
    TEST_ASSERT_TRUE(find(ramp_tick(2) + 10000, PATIENCE, EARLY));
    assert_at_step(2);
    TEST_ASSERT_EQUAL_UINT64(ramp_tick(2), place.entry.time.high);
    TEST_ASSERT_TRUE(find(ramp_tick(2) + 10000, PATIENCE, 9999));
    assert_at_step(3);
}

void test_the_step_before_the_wish_counts_in_the_grains_of_a_stop_of_its_own(void)
{
    start_ramp(1000, 100);
    const struct path_wish wish = {.tick = ramp_tick(2) + 10000,
                                   .patience_ticks = PATIENCE,
                                   .early_ticks = EARLY,
                                   .accel = 7U * STEP_ACCEL_PER_ACCEL};
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    TEST_ASSERT_EQUAL_UINT64(2U * PATH_GRAINS_PER_ACCEL * wish.accel, place.entry.place.low);
}

void test_where_a_step_is_due_soon_the_one_before_the_wish_is_not_taken(void)
{
    start_ramp(1000, 100);
    TEST_ASSERT_TRUE(find(ramp_tick(2) + 10000, ramp_tick(3) - ramp_tick(2) - 10000, EARLY));
    assert_at_step(3);
}

/* 1414 steps/s at step 1, 2000 at step 2. */
void test_where_the_next_step_may_come_before_the_wish_the_one_before_is_not_taken(void)
{
    start_ramp(10000, 1000000);
    TEST_ASSERT_TRUE(find(ramp_tick(1) + 10000, 100, EARLY));
    assert_at_step(1);
    TEST_ASSERT_TRUE(find(ramp_tick(2) + 10000, 100, EARLY));
    assert_at_step(3);
}

/* It stands at step 4, 0.4 s after its start. */
void test_at_the_last_step_before_a_rest_a_stop_is_taken_back(void)
{
    start_ramp(1000, 100);
    TEST_ASSERT_TRUE(find(ramp_tick(2), PATIENCE, 0));
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    hand_over(UINT64_MAX);
    uint64_t rest_tick = rig.path.rest.entry.time.high;
    TEST_ASSERT_FALSE(find(rest_tick + 10000, PATIENCE, 0));
    TEST_ASSERT_TRUE(find(rest_tick + 10000, PATIENCE, EARLY));
    assert_at_step(4);
    TEST_ASSERT_EQUAL_UINT64(0, place.entry.speed2);
}

void test_a_place_between_steps_is_no_step_before_the_wish(void)
{
    start();
    TEST_ASSERT_TRUE(find(START + 500000, PATIENCE, EARLY));
    change(1000);
    uint64_t tick = rig.path.origin.entry.time.high;
    TEST_ASSERT_TRUE(find(tick + 10000, PATIENCE, EARLY));
    assert_at_step(1);
}

void test_with_a_high_start_speed_no_step_before_the_wish_is_taken(void)
{
    for (unsigned speed = 1500; speed <= 1501; speed++) {
        begin();
        path_set_start_speed(&rig.path, speed * PATH_SPEED_UNITS);
        (void)rig_add(&rig, 3, 0, 10, 10000);
        start();
        uint64_t end_tick = rig.path.rest.entry.time.high;
        uint64_t tick = end_tick - STEP_TICKS + 10000;
        rig_set_speed(&rig.path, 0, 10 * PATH_SPEED_UNITS);
        TEST_ASSERT_TRUE(find(tick, PATIENCE, EARLY));
        TEST_ASSERT_UINT64_WITHIN(2, tick, place.entry.time.high);
        TEST_ASSERT_EQUAL(speed == 1500, find(end_tick + 10000, PATIENCE, EARLY + 20000) || speed == 1500);
    }
}

/* ---- the speed at a step --------------------------------------------------------------------------------------- */

void test_the_speed_at_steps_up_to_a_change_is_what_it_was_before(void)
{
    change_at_first_step();
    TEST_ASSERT_EQUAL_UINT32(10 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 1));
    TEST_ASSERT_EQUAL_UINT32(20 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 2));
    TEST_ASSERT_EQUAL_UINT32(0, path_speed_at(&rig.path, 0, 0));
    TEST_ASSERT_TRUE(find(rig.path.origin.entry.time.high + STEP_TICKS, UINT64_MAX / 2U, 0));
    assert_at_step(3);
    change(30);
    TEST_ASSERT_EQUAL_UINT32(20 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 3));
    TEST_ASSERT_EQUAL_UINT32(30 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 4));
}

/* No more than so many pulses, so that the next section is not laid. */
static void hand_over_pulses(unsigned axis, uint32_t count)
{
    struct path_segment next;
    while (count != 0U && path_next(&rig.path, axis, UINT64_MAX, &next)) {
        TEST_ASSERT_TRUE(next.segment.steps <= count);
        count -= next.segment.steps;
    }
    TEST_ASSERT_EQUAL_UINT32(0, count);
}

static void change_at_border(uint32_t section)
{
    hand_over_pulses(0, 100);
    hand_over_pulses(1, 33);
    TEST_ASSERT_EQUAL_UINT32(section, rig.path.laid);
    TEST_ASSERT_TRUE(find(rig.path.next.time.high - 1000U, UINT64_MAX / 2U, 0));
    TEST_ASSERT_EQUAL_UINT32(section, place.section);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
}

void test_a_change_at_a_border_of_what_is_not_laid_has_nothing_before_it(void)
{
    (void)rig_add(&rig, 100, 33, 10, 10000);
    (void)rig_add(&rig, 100, 33, 10, 10000);
    (void)rig_add(&rig, 100, 33, 10, 10000);
    TEST_ASSERT_TRUE(path_start(&rig.path, START));
    change_at_border(1);
    TEST_ASSERT_FALSE(before.valid);
    hand_over_pulses(0, 100);
    hand_over_pulses(1, 33);
    change_at_border(3);
    TEST_ASSERT_FALSE(before.valid);
    hand_over(UINT64_MAX);
    TEST_ASSERT_EQUAL_UINT32(10 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 3, 0));
}

/* It is laid, a change within the vector before it makes that void, and it is not laid again. */
void test_a_change_at_a_border_forgets_how_the_vector_after_it_was_laid_before(void)
{
    for (uint32_t section = 0; section < 2; section++) {
        begin();
        for (unsigned i = 0; i < 4; i++) {
            (void)rig_add(&rig, 100, 33, 10, 10000);
        }
        start();
        TEST_ASSERT_TRUE(find(START + (uint64_t)STEP_TICKS * (100U * section + 50U) - 1000U, UINT64_MAX / 2U, 0));
        TEST_ASSERT_EQUAL_UINT32(section, place.section);
        assert_at_step(50);
        TEST_ASSERT_TRUE(path_lay_course(&rig.path, section + 1U)->legs != 0);
        TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
        hand_over_pulses(0, 50);
        hand_over_pulses(1, 17);
        TEST_ASSERT_EQUAL_UINT32(section + 1U, rig.path.laid);
        TEST_ASSERT_TRUE(find(rig.path.next.time.high - 1000U, UINT64_MAX / 2U, 0));
        TEST_ASSERT_EQUAL_UINT32(section + 1U, place.section);
        TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
        TEST_ASSERT_FALSE(before.valid);
    }
}

void test_the_speeds_before_a_change_are_those_of_its_section(void)
{
    (void)rig_add(&rig, 100, 33, 20, 10000);
    start();
    TEST_ASSERT_TRUE(find(START + UINT64_C(50) * STEP_TICKS, UINT64_MAX / 2U, 0));
    change(30);
    TEST_ASSERT_TRUE(before.valid);
    TEST_ASSERT_EQUAL_UINT32(10 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 40));
    TEST_ASSERT_EQUAL_UINT32(20 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 1, 40));
}

void test_without_a_place_for_the_course_before_it_a_change_waits_for_one_that_is_pending(void)
{
    path_set_before(&rig.path, NULL);
    change_at_first_step();
    TEST_ASSERT_TRUE(find(START + 500000, PATIENCE, 0));
    assert_at_step(1);
    TEST_ASSERT_EQUAL_UINT32(10 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 0));
}

void test_a_start_forgets_the_speeds_before_it(void)
{
    change_at_first_step();
    TEST_ASSERT_TRUE(find(rig.path.origin.entry.time.high + STEP_TICKS, UINT64_MAX / 2U, 0));
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    hand_over(UINT64_MAX);
    TEST_ASSERT_TRUE(before.valid);
    TEST_ASSERT_TRUE(path_start(&rig.path, UINT64_C(1) << 32U));
    TEST_ASSERT_FALSE(before.valid);
}
