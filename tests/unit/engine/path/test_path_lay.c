/* What a path lays where it begins, is changed or brakes, and where its axes are at a place. */
#include "path_lay.h"
#include "path_look.h"
#include "path_rig.h"
#include "unity.h"

enum {
    LONG = 1000000000,
    TICKS = 400
};

static struct path_rig rig;
static uint64_t ticks[TICKS];
static uint64_t back[PATH_AXES];
static struct path_place place;

void setUp(void)
{
    rig_init(&rig);
}

void tearDown(void)
{
}

/* The pulses of x and y so many halves of a step after the beginning of the first vector. */
static void assert_pulses(uint32_t x, uint32_t y, uint64_t half_steps)
{
    uint32_t pulses[PATH_AXES];
    const struct path_place there = {
        .entry.place = path_wide_multiply(path_section_grains_per_step(&rig.ring[0]) / 2U, half_steps)};
    path_lay_pulses(&rig.path, &there, pulses);
    TEST_ASSERT_EQUAL_UINT32(x, pulses[0]);
    TEST_ASSERT_EQUAL_UINT32(y, pulses[1]);
    TEST_ASSERT_EQUAL_UINT32(0, pulses[2]);
}

static void find(uint64_t tick)
{
    const struct path_wish wish = {.tick = tick, .patience_ticks = UINT64_MAX / 2U};
    TEST_ASSERT_TRUE(path_find(&rig.path, &wish, &place));
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        (void)rig_pulses(&rig, axis, place.entry.time.high + 2U, ticks, 0);
    }
}

/* y has a pulse at one and a half steps of x. */
void test_a_pulse_of_a_shorter_axis_between_two_steps_counts_from_its_place_on(void)
{
    (void)rig_add(&rig, 3, 2, 1000, 10000);
    assert_pulses(1, 0, 2);
    assert_pulses(1, 1, 3);
    assert_pulses(2, 1, 4);
    assert_pulses(3, 2, 6);
}

void test_the_pulses_at_a_step_of_a_long_vector_are_its_share_of_the_way(void)
{
    (void)rig_add(&rig, LONG, LONG - 1, 1000, 10000);
    assert_pulses(4, 3, 8);
    assert_pulses(LONG / 2, LONG / 2 - 1, LONG);
    assert_pulses(LONG / 2, LONG / 2 - 1, LONG + 1);
    assert_pulses(LONG, LONG - 1, 2U * (uint64_t)LONG);
}

/* From 10 000 steps/s with 100 000 steps/s^2: 100 steps before the border, and 75 after it down to 5000. */
void test_a_path_that_is_too_fast_brakes_all_the_way_to_the_border(void)
{
    (void)rig_add(&rig, 1000, 0, 10000, 100000);
    (void)rig_add(&rig, 1000, 0, 10000, 100000);
    (void)path_start(&rig.path, 0);
    find(8400000 + 8400 * 400);
    rig_set_speed(&rig.path, 0, 5000 * PATH_SPEED_UNITS);
    rig_set_speed(&rig.path, 1, 5000 * PATH_SPEED_UNITS);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT(1100, rig_pulses(&rig, 0, UINT64_MAX, ticks, TICKS));
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(80000000) * 65536U, rig.ring[0].leave2);
    TEST_ASSERT_EQUAL_UINT64(rig.ring[0].leave2, rig.ring[1].enter2);
    for (unsigned i = 2; i < TICKS; i++) {
        TEST_ASSERT_TRUE(ticks[i] - ticks[i - 1] + 1U >= ticks[i - 1] - ticks[i - 2]);
    }
}

void test_the_lowest_start_speed_is_one(void)
{
    (void)rig_add(&rig, 100, 0, 1000, 10000);
    path_set_start_speed(&rig.path, 1);
    (void)path_start(&rig.path, 0);
    (void)rig_add(&rig, 100, 0, 1000, 10000);
    find(4200000);
    TEST_ASSERT_TRUE(rig_change(&rig, &place, back));
    TEST_ASSERT_EQUAL_UINT32(1, rig.path.known);
}
