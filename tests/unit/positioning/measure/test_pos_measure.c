/* The numbers that are expected were found with fractions. */
#include "unity.h"

#include "pos_measure.h"

#define COUNT_OF(rows) (sizeof(rows) / sizeof((rows)[0]))

enum {
    HIGHEST_SPEED = 51200000,
    HIGHEST_ACCEL = 1024000000,
};

struct place {
    struct pos_scale scale;
    int64_t from;
    int64_t to;
};

struct rate {
    struct pos_scale scale;
    uint32_t from;
    uint32_t to;
};

void setUp(void)
{
}

void tearDown(void)
{
}

void test_a_way_is_the_nearest_step_and_halves_go_up_on_both_sides_of_zero(void)
{
    static const struct place rows[] = {
        {{1, 10}, 4, 0},
        {{1, 10}, 5, 1},
        {{1, 10}, -5, 0},
        {{1, 10}, -6, -1},
        {{1, 10}, 14, 1},
        {{1, 10}, 15, 2},
        {{1, 10}, -15, -1},
        {{1, 10}, -16, -2},
        {{1, 10}, 1000005, 100001},
        {{1, 10}, -1000005, -100000},
        {{2, 4}, 1, 1},
        {{2, 4}, -1, 0},
        {{2, 4}, -3, -1},
        {{7, 3}, 1, 2},
        {{7, 3}, -1, -2},
        {{7, 3}, 2, 5},
        {{7, 3}, 100000001, 233333336},
    };
    for (unsigned i = 0; i < COUNT_OF(rows); i++) {
        TEST_ASSERT_EQUAL_INT64(rows[i].to, pos_measure_step(&rows[i].scale, rows[i].from));
    }
}

void test_a_way_is_right_with_the_least_and_the_largest_scale_and_at_the_bounds(void)
{
    static const struct place rows[] = {
        {{1, 10000}, 4999, 0},
        {{1, 10000}, 5000, 1},
        {{1, 10000}, -5000, 0},
        {{1, 10000}, -5001, -1},
        {{1, 10000}, POS_MEASURE_UM_MAX, 461168601842739},
        {{1, 10000}, -POS_MEASURE_UM_MAX, -461168601842739},
        {{500, 1}, 1, 500},
        {{500, 1}, -1, -500},
        {{500, 1}, INT64_C(9007199254740992), INT64_C(4503599627370496000)},
        {{500, 1}, -INT64_C(9007199254740992), -INT64_C(4503599627370496000)},
        {{2147483647, 2147483646}, 1073741823, 1073741824},
        {{2147483647, 2147483646}, -1073741823, -1073741823},
        {{2147483647, 2147483646}, INT64_C(2305843009213693952), INT64_C(2305843010287435777)},
        {{2147483647, 2147483646}, -INT64_C(2305843009213693952), -INT64_C(2305843010287435777)},
    };
    for (unsigned i = 0; i < COUNT_OF(rows); i++) {
        TEST_ASSERT_EQUAL_INT64(rows[i].to, pos_measure_step(&rows[i].scale, rows[i].from));
    }
}

void test_a_step_is_the_nearest_micrometre_and_halves_go_up(void)
{
    static const struct place rows[] = {
        {{1, 10}, 1, 10},
        {{1, 10}, -1, -10},
        {{1, 10000}, INT64_C(281474976710656), INT64_C(2814749767106560000)},
        {{1, 10000}, -INT64_C(281474976710656), -INT64_C(2814749767106560000)},
        {{500, 1}, 249, 0},
        {{500, 1}, 250, 1},
        {{500, 1}, -250, 0},
        {{500, 1}, -251, -1},
        {{500, 1}, INT64_C(2305843009213693952), INT64_C(4611686018427388)},
        {{7, 3}, 1, 0},
        {{7, 3}, 2, 1},
        {{7, 3}, -2, -1},
        {{7, 3}, INT64_C(1000000000001), INT64_C(428571428572)},
        {{4, 2}, 1, 1},
        {{4, 2}, -1, 0},
        {{4, 2}, -3, -1},
    };
    for (unsigned i = 0; i < COUNT_OF(rows); i++) {
        TEST_ASSERT_EQUAL_INT64(rows[i].to, pos_measure_um(&rows[i].scale, rows[i].from));
    }
}

void test_a_speed_is_rounded_once_kept_in_its_bound_and_0_only_of_0(void)
{
    static const struct rate rows[] = {
        {{1, 10}, 0, 0},
        {{1, 10}, 1, 1},
        {{1, 10}, UINT32_C(1000) << 16U, 426667},
        {{1, 10}, UINT32_MAX, 27962027},
        {{1, 10000}, 1, 1},
        {{1, 10000}, 76800000, 500},
        {{1, 10000}, UINT32_MAX, 27962},
        {{96, 25}, 2, 1},
        {{96, 25}, 3, 1},
        {{500, 1}, 1, 33},
        {{500, 1}, 1572863, HIGHEST_SPEED - 33},
        {{500, 1}, 1572864, HIGHEST_SPEED},
        {{500, 1}, 1572865, HIGHEST_SPEED},
        {{500, 1}, UINT32_MAX, HIGHEST_SPEED},
    };
    for (unsigned i = 0; i < COUNT_OF(rows); i++) {
        TEST_ASSERT_EQUAL_UINT32(rows[i].to, pos_measure_speed(&rows[i].scale, rows[i].from, HIGHEST_SPEED));
    }
}

void test_an_acceleration_is_rounded_once_kept_in_its_bound_and_0_only_of_0(void)
{
    static const struct rate rows[] = {
        {{1, 10}, 0, 0},
        {{1, 10}, 500, 6400000},
        {{1, 10}, 1, 12800},
        {{1, 10}, 65535, 838848000},
        {{1, 10000}, 1, 13},
        {{1, 10000}, 65535, 838848},
        {{3, 256000}, 1, 2},
        {{3, 256000}, 3, 5},
        {{500, 1}, 16, 1024000000},
        {{500, 1}, 17, HIGHEST_ACCEL},
        {{500, 1}, 65535, HIGHEST_ACCEL},
    };
    for (unsigned i = 0; i < COUNT_OF(rows); i++) {
        TEST_ASSERT_EQUAL_UINT32(rows[i].to, pos_measure_accel(&rows[i].scale, rows[i].from, HIGHEST_ACCEL));
    }
    TEST_ASSERT_EQUAL_UINT32(1, pos_measure_accel(&(struct pos_scale){.steps = 1, .micrometres = 2147483647}, 1, 10));
}

void test_the_feed_of_a_speed_ends_at_the_largest_number(void)
{
    static const struct rate rows[] = {
        {{1, 10}, 0, 0},
        {{1, 10}, 1, 154},
        {{1, 10}, 426667, 65536051},
        {{1, 10}, HIGHEST_SPEED, UINT32_MAX},
        {{1, 10000}, 1, 153600},
        {{1, 10000}, 27962, UINT32_C(4294963200)},
        {{1, 10000}, 27963, UINT32_MAX},
        {{1, 10000}, HIGHEST_SPEED, UINT32_MAX},
        {{500, 1}, 16, 0},
        {{500, 1}, 17, 1},
        {{500, 1}, HIGHEST_SPEED, 1572864},
    };
    for (unsigned i = 0; i < COUNT_OF(rows); i++) {
        TEST_ASSERT_EQUAL_UINT32(rows[i].to, pos_measure_feed(&rows[i].scale, rows[i].from));
    }
}

void test_the_last_and_the_first_step_of_a_way_are_those_whose_rounded_way_is_inside(void)
{
    static const struct {
        struct pos_scale scale;
        int64_t way_um;
        int64_t last;
        int64_t first;
    } rows[] = {
        {{1, 10}, 1234, 123, 124},    {{1, 10}, -1234, -124, -123}, {{1, 10}, 5, 0, 1},      {{1, 10}, -5, -1, 0},
        {{1, 10}, 0, 0, 0},           {{500, 1}, 0, 249, -250},     {{500, 1}, 1, 749, 250}, {{500, 1}, -1, -251, -750},
        {{7, 3}, 10, 24, 23},         {{7, 3}, -10, -23, -24},      {{7, 3}, 11, 26, 25},    {{1, 10000}, 20000, 2, 2},
        {{1, 10000}, -20000, -2, -2}, {{1, 10000}, 19999, 1, 2},
    };
    for (unsigned i = 0; i < COUNT_OF(rows); i++) {
        TEST_ASSERT_EQUAL_INT64(rows[i].last, pos_measure_last_step(&rows[i].scale, rows[i].way_um));
        TEST_ASSERT_EQUAL_INT64(rows[i].first, pos_measure_first_step(&rows[i].scale, rows[i].way_um));
    }
}
