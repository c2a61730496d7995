#include "path_lay.h"
#include "path_look.h"
#include "path_rig.h"
#include "unity.h"

enum {
    RING = 128
};

static struct path path;
static struct path_section ring[RING];
static uint32_t seed;

static uint32_t draw(uint32_t most)
{
    seed = seed * 1664525U + 1013904223U;
    return (seed >> 8U) % most;
}

/* Of any order of size: of 2^bits at most. */
static uint32_t draw_size(unsigned bits)
{
    return (UINT32_C(1) << draw(bits)) + draw(UINT32_C(1) << draw(bits));
}

static void add(uint32_t steps, uint32_t speed, uint32_t accel)
{
    struct path_vector vector = rig_vector((int32_t)steps, 0, speed, accel);
    TEST_ASSERT_TRUE(path_add(&path, &vector));
}

/* Adds a vector as path_add does; returns the first section whose plan that changes. */
static uint32_t look_at_another(uint32_t steps, uint32_t speed, uint32_t accel)
{
    struct path_vector vector = rig_vector((int32_t)steps, 0, speed, accel);
    path_section_take(path_section_of(&path, path.end), &vector);
    path.end++;
    path.known = path.end;
    return path_look_again(&path);
}

static void add_any(void)
{
    struct path_vector vector =
        rig_vector((int32_t)draw_size(10), (int32_t)draw_size(10), 10U + draw_size(16), 1U + draw_size(20));
    vector.border_speed = draw(4) != 0 ? UINT32_MAX : draw_size(20);
    vector.extent2 = draw(2) != 0 ? vector.extent2 : 1U + draw_size(20);
    TEST_ASSERT_TRUE(path_add(&path, &vector));
}

/* All speeds of the plan are those of one that begins anew. */
static void assert_planned_well(void)
{
    uint64_t exit2[RING];
    if (path.looked != path.known) {
        (void)path_look_again(&path);
    }
    for (uint32_t i = path.laid; i != path.known; i++) {
        exit2[i % RING] = ring[i % RING].exit2;
    }
    bool too_fast = path.too_fast;
    path_look(&path);
    TEST_ASSERT_EQUAL(path.too_fast, too_fast);
    for (uint32_t i = path.laid; i != path.known; i++) {
        TEST_ASSERT_EQUAL_UINT64(ring[i % RING].exit2, exit2[i % RING]);
    }
}

void setUp(void)
{
    path_init(&path, ring, RING, RIG_TURN_US);
}

void tearDown(void)
{
}

void test_a_vector_that_joins_leaves_the_plan_that_a_new_one_would_make(void)
{
    for (uint32_t run = 1; run < 1000; run++) {
        seed = run;
        path_init(&path, ring, RING, RIG_TURN_US);
        uint32_t there = 1U + draw(10);
        for (uint32_t i = 0; i < there; i++) {
            add_any();
        }
        (void)path_start(&path, 0);
        for (unsigned i = 0; i < 20 && !path_is_laid(&path); i++) {
            add_any();
            assert_planned_well();
            if (draw(3) == 0) {
                path_lay_next(&path);
            }
        }
    }
}

/* Where the path is too fast for speeds that were lowered, too. */
void test_a_vector_that_joins_a_path_that_is_too_fast_leaves_the_plan_that_a_new_one_would_make(void)
{
    for (uint32_t run = 1; run < 500; run++) {
        seed = run;
        path_init(&path, ring, RING, RIG_TURN_US);
        for (uint32_t i = 0; i < 20; i++) {
            add_any();
        }
        (void)path_start(&path, 0);
        path_lay_next(&path);
        struct path_place place = {.section = 1, .entry = path.next};
        uint32_t slow = 1U + draw_size(20);
        for (uint32_t i = 1; i < 20; i++) {
            rig_set_speed(&path, i, slow);
        }
        path_lay_begin(&path, &place);
        for (unsigned i = 0; i < 10; i++) {
            add_any();
            assert_planned_well();
        }
    }
}

/* The way of a vector whose own speeds are many of those at a border: less than one of these is gained on it. */
void test_planning_goes_back_through_a_vector_that_gains_no_speed(void)
{
    struct path_vector slow = rig_vector(1, 0, 1000, 1);
    slow.accel = 1;
    struct path_vector wide = rig_vector(1 << 20, 0, STEP_SPEED_MAX, 1);
    wide.accel = 1;
    wide.extent2 = 1;
    TEST_ASSERT_TRUE(path_add(&path, &slow));
    TEST_ASSERT_TRUE(path_add(&path, &wide));
    add(10, 1000, 1000);
    (void)path_start(&path, 0);
    TEST_ASSERT_EQUAL_UINT64(0, ring[1].gain2);
    TEST_ASSERT_TRUE(ring[1].exit2 > 0);
    add(10, 1000, 1000);
    assert_planned_well();
}

/* 40 000 steps/s^2 brake from 2000 steps/s within 50 steps: five vectors. */
void test_planning_goes_back_no_farther_than_to_where_the_brake_begins(void)
{
    for (unsigned i = 0; i < 100; i++) {
        add(10, 2000, 40000);
    }
    (void)path_start(&path, 0);
    TEST_ASSERT_UINT_WITHIN(1, 101 - 5, look_at_another(10, 2000, 40000));
    TEST_ASSERT_EQUAL_UINT32(100, path_look_again(&path));
}

/* Speeds up all the way: what is laid next is as fast as it can get, whatever is added. */
void test_nothing_is_looked_at_while_the_path_is_still_getting_faster(void)
{
    for (unsigned i = 0; i < 100; i++) {
        add(10, 100000, 1000);
    }
    (void)path_start(&path, 0);
    path_lay_next(&path);
    add(10, 100000, 1000);
    path_lay_next(&path);
    TEST_ASSERT_EQUAL_UINT32(100, path.looked);
    assert_planned_well();
}

void test_nothing_is_looked_at_in_a_cruise_before_the_brake_begins(void)
{
    for (unsigned i = 0; i < 100; i++) {
        add(10, 2000, 40000);
    }
    (void)path_start(&path, 0);
    for (unsigned i = 0; i < 50; i++) {
        path_lay_next(&path);
    }
    add(10, 2000, 40000);
    for (unsigned i = 50; i < 94; i++) {
        path_lay_next(&path);
        TEST_ASSERT_EQUAL_UINT32(100, path.looked);
        TEST_ASSERT_FALSE(path_lags(&path));
    }
    path_lay_next(&path);
    path_lay_next(&path);
    TEST_ASSERT_EQUAL_UINT32(101, path.looked);
}

/* What was the end is laid with what comes after it. */
void test_an_end_that_vectors_have_been_added_to_is_looked_at_before_it_is_laid(void)
{
    add(10, 2000, 40000);
    add(10, 2000, 40000);
    (void)path_start(&path, 0);
    path_lay_next(&path);
    TEST_ASSERT_FALSE(path_lags(&path));
    add(1000, 2000, 40000);
    TEST_ASSERT_EQUAL_UINT32(2, path.looked);
    path_lay_next(&path);
    TEST_ASSERT_EQUAL_UINT32(3, path.looked);
    TEST_ASSERT_TRUE(ring[1].exit2 > 0);
}

/* Vectors that are added one by one, or all before the path is looked at. */
void test_vectors_that_join_together_leave_the_plan_that_a_new_one_would_make(void)
{
    for (uint32_t run = 1; run < 500; run++) {
        seed = run;
        path_init(&path, ring, RING, RIG_TURN_US);
        for (uint32_t i = 1U + draw(10); i > 0; i--) {
            add_any();
        }
        (void)path_start(&path, 0);
        for (unsigned i = 0; i < 10 && !path_is_laid(&path); i++) {
            for (uint32_t more = draw(9); more > 0; more--) {
                add_any();
            }
            if (draw(2) == 0) {
                assert_planned_well();
            }
            path_lay_next(&path);
        }
    }
}

void test_a_stop_rests_where_it_has_braked_to_the_start_speed(void)
{
    path_init(&path, ring, RING, 12);
    add(1000, 1000, 1000);
    const struct path_section *section = path_section_of(&path, 0);
    path_set_start_speed(&path, 100);
    path.stopping = true;
    TEST_ASSERT_EQUAL_UINT64(0, path_look_exit2(&path, section, section->gain2 + UINT64_C(10000)));
    TEST_ASSERT_EQUAL_UINT64(10001, path_look_exit2(&path, section, section->gain2 + UINT64_C(10001)));
}

void test_a_course_that_is_not_kept_is_laid_once_more(void)
{
    path_init(&path, ring, RING, 12);
    add(1000, 1000, 1000);
    TEST_ASSERT_TRUE(path_start(&path, 1000));
    path_lay_next(&path);
    struct path_course kept = *path_lay_course(&path, 0);
    for (unsigned i = 0; i < PATH_KEPT; i++) {
        path.kept[i].valid = false;
    }
    const struct path_course *course = path_lay_course(&path, 0);
    TEST_ASSERT_EQUAL_UINT(kept.legs, course->legs);
    TEST_ASSERT_EQUAL_UINT64(kept.end_time.high, course->end_time.high);
    TEST_ASSERT_EQUAL_UINT64(kept.end_time.low, course->end_time.low);
}

/* Each of them gains 200 000 (steps/s)^2; the second one is to be left with that, as the third one ends the path. */
void test_a_vector_that_was_to_brake_for_the_end_speeds_up_where_others_have_joined(void)
{
    for (unsigned i = 0; i < 3; i++) {
        add(10, 1000, 10000);
    }
    (void)path_start(&path, 0);
    path_lay_next(&path);
    for (unsigned i = 0; i < 3; i++) {
        add(10, 1000, 10000);
    }
    path_lay_next(&path);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(200000) * 65536U, ring[0].leave2);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(400000) * 65536U, ring[1].leave2);
}

void test_what_the_brake_leaves_over_is_the_speed_at_the_end(void)
{
    add(10, 1000, 10000);
    ring[0].exit2 = 0;
    TEST_ASSERT_EQUAL_UINT64(0, path_look_exit2(&path, &ring[0], ring[0].gain2));
    TEST_ASSERT_EQUAL_UINT64(1, path_look_exit2(&path, &ring[0], ring[0].gain2 + 1U));
}

/* 10 steps before a border, with 1 step/s^2: u + 1 cannot be braked to u where (u + 1)^2 is one more than
 * u^2 + 1024*128*10. What follows is long enough to end from there. */
void test_a_path_that_is_too_fast_by_the_least_that_there_is_is_too_fast(void)
{
    const uint32_t slow = 512U * 128U * 10U;
    struct path_vector vector = rig_vector(1000, 0, 1, 1);
    vector.speed = slow + 1U;
    TEST_ASSERT_TRUE(path_add(&path, &vector));
    vector = rig_vector(4000000, 0, 1, 1);
    vector.speed = slow;
    TEST_ASSERT_TRUE(path_add(&path, &vector));
    (void)path_start(&path, 0);
    path_lay_next(&path);
    rig_set_speed(&path, 0, slow);
    struct path_place place = {.entry = {.speed2 = ((uint64_t)slow + 1U) * (slow + 1U)}};
    place.entry.place = path_wide_multiply(path_section_grains_per_step(&ring[0]), 990);
    path_lay_begin(&path, &place);
    TEST_ASSERT_TRUE(path.too_fast);
    TEST_ASSERT_EQUAL_UINT64((uint64_t)slow * slow + 1U, ring[0].exit2);
    place.entry.place = path_wide_multiply(path_section_grains_per_step(&ring[0]), 989);
    path_lay_begin(&path, &place);
    TEST_ASSERT_FALSE(path.too_fast);
    TEST_ASSERT_EQUAL_UINT64((uint64_t)slow * slow, ring[0].exit2);
}

static void add_of_extent(int32_t steps, uint64_t extent2)
{
    struct path_vector vector = rig_vector(steps, 0, 1000000, 8000000);
    vector.extent2 = extent2;
    TEST_ASSERT_TRUE(path_add(&path, &vector));
}

static void lay_two(void)
{
    TEST_ASSERT_TRUE(path_start(&path, 0));
    path_lay_next(&path);
    path_lay_next(&path);
}

/* Eight times its steps is the length that speeds count: the border is passed with 2^30 of that, 524 288 steps/s. */
void test_a_border_is_passed_no_faster_than_its_number_goes(void)
{
    add_of_extent(200000, UINT64_C(1600000) * 1600000);
    add_of_extent(200000, UINT64_C(1600000) * 1600000);
    lay_two();
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(1) << 54, ring[1].enter2);
}

void test_a_border_of_vectors_of_one_step_may_have_a_number_that_is_a_stand(void)
{
    add_of_extent(1, UINT64_C(3) << 62);
    add_of_extent(1, UINT64_C(3) << 62);
    lay_two();
    TEST_ASSERT_EQUAL_UINT64(0, ring[1].enter2);
    TEST_ASSERT_EQUAL_UINT64(0, ring[1].leave2);
}

/* From 1 000 000 steps/s: with an eighth of the acceleration it would come to the border with 920 000, which the second
 * vector counts four times. */
void test_a_stop_that_brakes_less_than_planned_is_refused_where_a_vector_counts_another_length(void)
{
    add(200000, 1000000, 8000000);
    struct path_vector vector = rig_vector(2000000, 0, 1000000, 500000);
    vector.extent2 = UINT64_C(500000) * 500000;
    TEST_ASSERT_TRUE(path_add(&path, &vector));
    TEST_ASSERT_TRUE(path_start(&path, 0));
    const uint32_t own = ring[0].vector.accel;
    struct path_wish wish = {.tick = 15960000, .patience_ticks = UINT64_MAX / 2U, .accel = own / 8U};
    struct path_place place;
    TEST_ASSERT_TRUE(path_find(&path, &wish, &place));
    TEST_ASSERT_FALSE(path_can_rest(&path, &place));
    wish.accel = own;
    TEST_ASSERT_TRUE(path_find(&path, &wish, &place));
    TEST_ASSERT_TRUE(path_can_rest(&path, &place));
}
