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

static unsigned pulses(unsigned axis, uint64_t until_tick)
{
    return rig_pulses(&rig, axis, until_tick, ticks, TICKS);
}

static void all_pulses(uint64_t until_tick)
{
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        (void)pulses(axis, until_tick);
    }
}

static bool find(uint64_t tick, uint64_t patience_ticks)
{
    return path_find(&rig.path, &(struct path_wish){.tick = tick, .patience_ticks = patience_ticks}, &place);
}

static void assert_found(uint32_t section, uint32_t step)
{
    TEST_ASSERT_EQUAL_UINT32(section, place.section);
    uint64_t grains = path_section_grains_per_step(path_section_of(&rig.path, section));
    TEST_ASSERT_EQUAL_UINT64(0, place.entry.place.high);
    TEST_ASSERT_EQUAL_UINT64(step * grains, place.entry.place.low);
}

/* 10 000 steps/s, ramps of 50 steps in 840 000 ticks, then 8400 ticks a step. */
void setUp(void)
{
    rig_init(&rig);
    (void)rig_add(&rig, 1000, 333, 10000, 1000000);
}

void tearDown(void)
{
}

static void start(void)
{
    TEST_ASSERT_TRUE(path_start(&rig.path, 1000));
}

void test_a_path_that_stands_has_no_place_to_change(void)
{
    TEST_ASSERT_FALSE(find(0, UINT64_MAX / 2U));
}

void test_the_place_of_a_change_is_the_first_step_at_or_after_its_tick(void)
{
    start();
    TEST_ASSERT_TRUE(find(1001, UINT64_MAX / 2U));
    assert_found(0, 1);
    TEST_ASSERT_TRUE(find(1000 + 840000, UINT64_MAX / 2U));
    assert_found(0, 50);
    TEST_ASSERT_TRUE(find(1000 + 840001, UINT64_MAX / 2U));
    assert_found(0, 51);
    TEST_ASSERT_TRUE(find(1000 + 9121206, UINT64_MAX / 2U));
    assert_found(0, 999);
    TEST_ASSERT_FALSE(find(1000 + 9121207, UINT64_MAX / 2U));
    TEST_ASSERT_FALSE(find(1000 + 9240001, UINT64_MAX / 2U));
}

void test_every_step_of_a_path_is_found_from_its_tick_and_from_the_one_before(void)
{
    (void)rig_add(&rig, 21, 5, 20000, 700000);
    start();
    TEST_ASSERT_EQUAL_UINT(1021, pulses(0, UINT64_MAX));
    for (unsigned i = 1; i < 1020; i++) {
        TEST_ASSERT_TRUE(find(ticks[i - 1U] + 1U, UINT64_MAX / 2U));
        assert_found(i < 999 ? 0 : 1, i < 999 ? i + 1U : i - 999U);
        TEST_ASSERT_UINT64_WITHIN(1, ticks[i], place.entry.time.high);
    }
}

void test_a_border_is_the_beginning_of_the_next_vector(void)
{
    (void)rig_add(&rig, 100, 0, 10000, 1000000);
    start();
    TEST_ASSERT_TRUE(find(1000 + 840000 + 8400 * 950, UINT64_MAX / 2U));
    assert_found(1, 0);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(2560000) * 2560000, place.entry.speed2);
}

/* X goes at 10 000 steps/s in terms of its own; (3000, 4000) counts a way of 5000, on which that is 8000 of Y. */
void test_a_border_has_the_speed_as_the_next_vector_counts_it(void)
{
    struct path_vector vector = rig_vector(3000, 4000, 10000, 1000000);
    vector.extent2 = UINT64_C(25000000);
    TEST_ASSERT_TRUE(path_add(&rig.path, &vector));
    start();
    TEST_ASSERT_TRUE(find(1000 + 840000 + 8400 * 950, UINT64_MAX / 2U));
    assert_found(1, 0);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(2048000) * 2048000, place.entry.speed2);
}

void test_a_cruise_whose_next_step_is_far_is_changed_between_steps(void)
{
    start();
    const uint64_t tick = 1000 + 840000 + 8400 * 10 + 4200;
    TEST_ASSERT_TRUE(find(tick, 4199));
    uint64_t grains = path_section_grains_per_step(&rig.ring[0]);
    TEST_ASSERT_UINT64_WITHIN(2, grains * 60U + grains / 2U, place.entry.place.low);
    TEST_ASSERT_EQUAL_UINT64(0, place.entry.place.low % 2U);
    TEST_ASSERT_UINT64_WITHIN(1, tick, place.entry.time.high);
    TEST_ASSERT_TRUE(find(tick, 4200));
    assert_found(0, 61);
    TEST_ASSERT_TRUE(find(1000 + 8400 * 40, 1));
    assert_found(0, 8);
}

void test_just_before_the_end_of_a_cruise_its_end_is_waited_for(void)
{
    (void)rig_add(&rig, 100, 0, 1, 1000000);
    start();
    uint64_t end = 0;
    TEST_ASSERT_TRUE(find(1000 + 840000, UINT64_MAX / 2U));
    all_pulses(2000000);
    const struct path_course *course = &rig.path.kept[0].course;
    end = course->leg[1].end.low;
    struct path_entry entry = path_course_at(course, &course->leg[1], (struct wide){.low = end & ~UINT64_C(1)});
    TEST_ASSERT_TRUE(find(entry.time.high, 0));
    TEST_ASSERT_EQUAL_UINT64(0, place.entry.place.low % path_section_grains_per_step(&rig.ring[0]));
}

/* 1.25 steps of ramp in 2.5 ms; the cruise ends after 10 ms at 8.75 steps. */
void test_at_the_very_end_of_a_cruise_the_next_step_is_waited_for(void)
{
    rig_init(&rig);
    (void)rig_add(&rig, 10, 0, 1000, 400000);
    start();
    TEST_ASSERT_TRUE(find(1000 + 840000 - 10, 0));
    TEST_ASSERT_UINT64_WITHIN(1, 1000 + 840000 - 10, place.entry.time.high);
    TEST_ASSERT_TRUE(find(1000 + 840000, 0));
    assert_found(0, 9);
}

void test_before_a_cruise_begins_its_first_step_is_waited_for(void)
{
    start();
    TEST_ASSERT_TRUE(find(1000 + 840000 + 4200, 0));
    all_pulses(2000000);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    const struct path_wish wish = {.tick = 1000 + 840000, .accel = rig.ring[0].vector.accel};
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    assert_found(0, 51);
}

void test_before_a_path_leaves_its_stand_it_is_changed_and_stopped_there(void)
{
    start();
    all_pulses(2000000);
    TEST_ASSERT_TRUE(find(1000, UINT64_MAX / 2U));
    assert_found(0, 0);
    rig_set_speed(&rig.path, 0, 256);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    TEST_ASSERT_TRUE(find(0, UINT64_MAX / 2U));
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(0, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(1000, rig.path.rest.entry.time.high);
}

void test_a_second_change_takes_effect_where_the_first_does_if_both_come_before_it(void)
{
    start();
    all_pulses(2000000);
    const uint64_t tick = 1000 + 840000 + 1;
    TEST_ASSERT_TRUE(find(tick, UINT64_MAX / 2U));
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    all_pulses(2000000);
    TEST_ASSERT_TRUE(find(tick, UINT64_MAX / 2U));
    assert_found(0, 51);
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(50, pulses(0, UINT64_MAX));
}

void test_a_stop_with_its_own_acceleration_takes_effect_where_another_change_does(void)
{
    start();
    all_pulses(2000000);
    TEST_ASSERT_TRUE(find(1000 + 840000 + 1, UINT64_MAX / 2U));
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    all_pulses(2000000);
    const struct path_wish wish = {.tick = 1000 + 840000 + 1, .accel = 2U * rig.ring[0].vector.accel};
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(25, pulses(0, UINT64_MAX));
}

void test_a_stop_rests_where_its_ramp_ends_and_takes_back_what_comes_later(void)
{
    start();
    all_pulses(UINT64_MAX);
    TEST_ASSERT_TRUE(find(1000 + 2940000, UINT64_MAX / 2U));
    assert_found(0, 300);
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT64(700, back[0]);
    TEST_ASSERT_EQUAL_UINT64(333 - 99, back[1]);
    TEST_ASSERT_EQUAL_UINT64(0, back[2]);
    TEST_ASSERT_FALSE(path_lags(&rig.path));
    TEST_ASSERT_EQUAL_UINT(50, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(1000 + 2948442, ticks[0]);
    TEST_ASSERT_EQUAL_UINT64(1000 + 3780000, ticks[49]);
    TEST_ASSERT_EQUAL_UINT(17, pulses(1, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT32(0, rig.path.rest.section);
    TEST_ASSERT_EQUAL_UINT64(1000 + 3780000, rig.path.rest.entry.time.high);
}

void test_a_stopped_path_goes_on_and_ends_where_it_would_have(void)
{
    start();
    all_pulses(UINT64_MAX);
    (void)find(1000 + 2940000, UINT64_MAX / 2U);
    (void)rig_stop(&rig, &place, back);
    all_pulses(UINT64_MAX);
    TEST_ASSERT_TRUE(path_start(&rig.path, 3782000));
    TEST_ASSERT_EQUAL_UINT(650, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(3782000 + 6300000, ticks[649]);
    TEST_ASSERT_EQUAL_UINT(333 - 116, pulses(1, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(3782000 + 6300000, ticks[216]);
}

void test_a_stop_brakes_with_the_acceleration_of_each_vector_that_it_comes_through(void)
{
    (void)rig_add(&rig, 100, 0, 10000, 500000);
    (void)rig_add(&rig, 100, 0, 10000, 500000);
    start();
    all_pulses(UINT64_MAX);
    TEST_ASSERT_TRUE(find(1000 + 840000 + 8400 * 925, UINT64_MAX / 2U));
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT64(225, back[0]);
    /* Half of the way with 1 000 000, the other half with 500 000: 25 + 50 steps. */
    TEST_ASSERT_EQUAL_UINT(75, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.rest.section);
    TEST_ASSERT_EQUAL_UINT64(50 * path_section_grains_per_step(&rig.ring[1]), rig.path.rest.entry.place.low);
}

void test_a_rest_at_a_border_is_that_before_the_next_vector(void)
{
    (void)rig_add(&rig, 100, 0, 10000, 1000000);
    start();
    all_pulses(UINT64_MAX);
    TEST_ASSERT_TRUE(find(1000 + 840000 + 8400 * 900, UINT64_MAX / 2U));
    assert_found(0, 950);
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(50, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.rest.section);
    TEST_ASSERT_EQUAL_UINT64(0, rig.path.rest.entry.place.low);
    TEST_ASSERT_TRUE(path_start(&rig.path, 50000000));
    TEST_ASSERT_EQUAL_UINT(100, pulses(0, UINT64_MAX));
}

void test_a_stop_may_have_an_acceleration_of_its_own(void)
{
    (void)rig_add(&rig, 100, 0, 10000, 1000000);
    start();
    all_pulses(UINT64_MAX);
    const struct path_wish wish = {
        .tick = 1000 + 2940000, .patience_ticks = UINT64_MAX / 2U, .accel = 2000000 * STEP_ACCEL_PER_ACCEL};
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(25, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT32(wish.accel, rig.ring[0].vector.accel);
    TEST_ASSERT_EQUAL_UINT32(wish.accel, rig.ring[1].vector.accel);
}

/* A path that speeds up faster reaches the first pulse of an axis that turns sooner. */
void test_with_another_acceleration_an_axis_that_turns_is_slower_at_the_border(void)
{
    (void)rig_add(&rig, -100, 0, 200000, 1000000);
    start();
    all_pulses(1);
    uint64_t turn2 = rig.ring[1].border2;
    const struct path_wish wish = {
        .tick = 0, .patience_ticks = UINT64_MAX / 2U, .accel = STEP_ACCEL_MAX * STEP_ACCEL_PER_ACCEL};
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    all_pulses(place.entry.time.high + 2U);
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    /* 48 steps/s instead of 6: 12 us of half the acceleration. */
    uint64_t speed = (UINT64_C(256000000) + 11U) / 12U - 48U * PATH_SPEED_UNITS;
    TEST_ASSERT_UINT64_WITHIN(2U * speed, speed * speed, rig.ring[1].border2);
    TEST_ASSERT_TRUE(rig.ring[1].border2 < turn2);
}

void test_a_change_of_speed_takes_effect_at_its_place(void)
{
    start();
    all_pulses(2940000);
    TEST_ASSERT_TRUE(find(1000 + 2940000, UINT64_MAX / 2U));
    all_pulses(2950000);
    rig_set_speed(&rig.path, 0, 20000 * PATH_SPEED_UNITS);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    /* 150 steps of ramp to 20 000, which takes 0.01 s. */
    TEST_ASSERT_EQUAL_UINT(700, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(1000 + 2940000 + 840000, ticks[149]);
    TEST_ASSERT_EQUAL_UINT64(1000 + 2940000 + 840000 + 4200, ticks[150]);
}

/* From 10 000 to 5000 steps/s with 100 000 steps/s^2 takes 375 steps; the vector has 100 left. */
void test_what_is_too_fast_after_a_change_brakes_through_several_vectors(void)
{
    rig_init(&rig);
    for (unsigned i = 0; i < 5; i++) {
        (void)rig_add(&rig, i == 0 ? 1000 : 200, 0, 10000, 100000);
    }
    start();
    all_pulses(UINT64_MAX);
    TEST_ASSERT_TRUE(find(1000 + 8400000 + 8400 * 400, UINT64_MAX / 2U));
    assert_found(0, 900);
    for (uint32_t i = 0; i < 5; i++) {
        rig_set_speed(&rig.path, i, 5000 * PATH_SPEED_UNITS);
    }
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(900, pulses(0, UINT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(80000000) * 65536, rig.ring[0].exit2);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(40000000) * 65536, rig.ring[1].exit2);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(25000000) * 65536, rig.ring[2].exit2);
}

void test_a_change_is_refused_while_an_axis_has_not_been_handed_over_as_far(void)
{
    (void)rig_add(&rig, 100, 40, 10000, 1000000);
    start();
    TEST_ASSERT_TRUE(find(1000 + 2940000, UINT64_MAX / 2U));
    (void)pulses(0, 3000000);
    TEST_ASSERT_FALSE(rig_change(&rig, &place, back));
    (void)pulses(1, 2000000);
    (void)pulses(1, 3000000);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    all_pulses(3000000);
    TEST_ASSERT_TRUE(find(9000000, UINT64_MAX / 2U));
    TEST_ASSERT_EQUAL_UINT32(1, place.section);
    (void)pulses(0, 9100000);
    TEST_ASSERT_FALSE(rig_stop(&rig, &place, back));
    all_pulses(9100000);
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
}

void test_pulses_that_are_missing_in_a_vector_before_the_place_or_in_its_own_refuse_a_change(void)
{
    rig_init(&rig);
    (void)rig_add(&rig, 100, 40, 10000, 1000000);
    (void)rig_add(&rig, 100, 40, 1000, 1000000);
    start();
    (void)pulses(0, 3000000);
    TEST_ASSERT_TRUE(find(2000000, UINT64_MAX / 2U));
    TEST_ASSERT_EQUAL_UINT32(1, place.section);
    TEST_ASSERT_FALSE(rig_change(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(40, pulses(1, rig.ring[1].entered.high + 2U));
    TEST_ASSERT_FALSE(rig_change(&rig, &place, back));
    (void)pulses(1, 3000000);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
}

/* Axis 1 has no pulse in the vectors before the place, and none has been handed over. */
void test_an_axis_that_rests_does_not_hold_up_a_change(void)
{
    rig_init(&rig);
    (void)rig_add(&rig, 100, 0, 10000, 1000000);
    (void)rig_add(&rig, 100, 1, 10000, 1000000);
    start();
    (void)pulses(0, 1500000);
    TEST_ASSERT_TRUE(find(1300000, UINT64_MAX / 2U));
    TEST_ASSERT_EQUAL_UINT32(1, place.section);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(1, pulses(1, UINT64_MAX));
}

void test_a_change_in_an_earlier_vector_takes_back_those_after_it(void)
{
    (void)rig_add(&rig, 100, -40, 10000, 1000000);
    (void)rig_add(&rig, 100, 40, 10000, 1000000);
    start();
    all_pulses(UINT64_MAX);
    TEST_ASSERT_TRUE(find(1000 + 2940000, UINT64_MAX / 2U));
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT64(900, back[0]);
    TEST_ASSERT_EQUAL_UINT64(333 - 99 + 80, back[1]);
}

void test_a_vector_that_came_late_joins_by_a_change(void)
{
    start();
    all_pulses(UINT64_MAX);
    (void)rig_add(&rig, 1000, 0, 10000, 1000000);
    TEST_ASSERT_TRUE(find(1000 + 8400000 + 1, UINT64_MAX / 2U));
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    TEST_ASSERT_FALSE(path_lags(&rig.path));
    TEST_ASSERT_TRUE(rig.ring[0].exit2 > 0);
    TEST_ASSERT_EQUAL_UINT(1000 + 49, pulses(0, UINT64_MAX));
}

void test_a_vector_that_comes_while_the_path_stops_waits(void)
{
    start();
    all_pulses(UINT64_MAX);
    (void)find(1000 + 2940000, UINT64_MAX / 2U);
    (void)rig_stop(&rig, &place, back);
    (void)rig_add(&rig, 1000, 0, 10000, 1000000);
    TEST_ASSERT_EQUAL_UINT(50, pulses(0, UINT64_MAX));
    TEST_ASSERT_TRUE(path_start(&rig.path, 5000000));
    TEST_ASSERT_EQUAL_UINT(650 + 1000, pulses(0, UINT64_MAX));
}

void test_a_stop_at_a_stand_moves_nothing(void)
{
    start();
    all_pulses(UINT64_MAX);
    (void)find(1000 + 2940000, UINT64_MAX / 2U);
    (void)rig_stop(&rig, &place, back);
    all_pulses(UINT64_MAX);
    (void)path_start(&rig.path, 5000000);
    place = rig.path.origin;
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(0, pulses(0, UINT64_MAX));
    TEST_ASSERT_FALSE(find(5000001, UINT64_MAX / 2U));
    TEST_ASSERT_TRUE(find(5000000, UINT64_MAX / 2U));
    TEST_ASSERT_EQUAL_UINT64(5000000, rig.path.rest.entry.time.high);
}

void test_a_stop_with_its_own_acceleration_that_is_too_weak_does_not_come_to_rest(void)
{
    start();
    all_pulses(UINT64_MAX);
    const uint32_t own = rig.ring[0].vector.accel;
    struct path_wish wish = {.tick = 1000 + 2940000 + 8400 * 450, .patience_ticks = UINT64_MAX / 2U, .accel = own};
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    TEST_ASSERT_TRUE(path_can_rest(&rig.path, &place));
    wish.accel = own / 20U;
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    TEST_ASSERT_FALSE(path_can_rest(&rig.path, &place));
    wish.accel = own / 4U;
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    TEST_ASSERT_TRUE(path_can_rest(&rig.path, &place));
}

void test_a_stop_with_its_own_acceleration_between_steps_has_the_way_from_the_next_step_on(void)
{
    start();
    all_pulses(UINT64_MAX);
    const uint32_t own = rig.ring[0].vector.accel;
    const struct path_wish wish = {.tick = 1000 + 2940000 + 4200, .accel = own / 7U};
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    TEST_ASSERT_TRUE(place.entry.place.low % (PATH_GRAINS_PER_ACCEL * place.accel) != 0);
    TEST_ASSERT_TRUE(path_can_rest(&rig.path, &place));
}

/* From 0 with 1 000 000 steps/s^2 to 10 000 steps/s at step 50. */
void test_the_speed_at_a_step_is_that_of_the_plan(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, path_speed_at(&rig.path, 0, 0));
    start();
    TEST_ASSERT_EQUAL_UINT32(0, path_speed_at(&rig.path, 0, 25));
    all_pulses(UINT64_MAX);
    TEST_ASSERT_EQUAL_UINT32(0, path_speed_at(&rig.path, 0, 0));
    TEST_ASSERT_EQUAL_UINT32(2000 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 2));
    TEST_ASSERT_EQUAL_UINT32(10000 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 50));
    TEST_ASSERT_EQUAL_UINT32(10000 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 950));
    TEST_ASSERT_EQUAL_UINT32(2000 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 998));
    TEST_ASSERT_EQUAL_UINT32(0, path_speed_at(&rig.path, 0, 1000));
}

void test_the_speed_at_a_step_before_two_changes_is_that_at_the_first_one(void)
{
    static struct path_kept before;
    path_set_before(&rig.path, &before);
    start();
    all_pulses(UINT64_MAX);
    TEST_ASSERT_TRUE(find(1000 + 2940000, UINT64_MAX / 2U));
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    all_pulses(UINT64_MAX);
    TEST_ASSERT_EQUAL_UINT32(2000 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 2));
    TEST_ASSERT_TRUE(find(place.entry.time.high + 8400 * 20, UINT64_MAX / 2U));
    TEST_ASSERT_TRUE(rig_stop(&rig, &place, back));
    all_pulses(UINT64_MAX);
    TEST_ASSERT_EQUAL_UINT32(10000 * PATH_SPEED_UNITS, path_speed_at(&rig.path, 0, 2));
}
