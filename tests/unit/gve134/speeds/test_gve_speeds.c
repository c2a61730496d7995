#include "gve_speeds.h"
#include "unity.h"

#include <stddef.h>

/* The numbers of all tables are those of tests/support/gve_speeds_reference.py, which has whole roots and fractions. */
#define TOP GVE_SPEED_TOP
#define ONE GVE_FACTOR_ONE
#define FACTOR_MIN GVE_FACTOR_PER_CENT
#define FACTOR_MAX (1000U * GVE_FACTOR_PER_CENT)
#define MOST INT32_MAX
#define FREE {TOP, TOP, TOP, TOP} /* no VL */
#define VK true
#define VN false
#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])

struct limit_case {
    uint32_t speed;
    uint32_t brake;
    uint32_t short_pulses;
    bool corrected;
    int32_t steps[PATH_AXES];
    uint32_t factor;
    uint32_t limit[PATH_AXES];
    uint32_t expected; /* U */
    const char *what;
};

/* clang-format off */
static const struct limit_case limits[] = {
    {1000, TOP, 512, VN, {1000, 0, 0, 0}, ONE, FREE, 256000, "V in 1/256"},
    {10000, TOP, 512, VN, {3000, 4000, 0, 0}, ONE, FREE, 2560000, "VN minds no direction"},
    {10000, TOP, 512, VK, {3000, 4000, 0, 0}, ONE, FREE, 2048000, "VK: V*4/5"},
    {9000, TOP, 512, VK, {1000, -2000, 2000, 0}, ONE, FREE, 1536000, "VK in space: V*2/3"},
    {3000, TOP, 512, VK, {0, 0, -700, 0}, ONE, FREE, 768000, "VK, an axis alone"},
    {3000, TOP, 512, VK, {0, 0, 0, 700}, ONE, FREE, 768000, "VK, A alone"},
    {1000, TOP, 512, VK, {300, 400, 0, 1000}, ONE, FREE, 512000, "VK, A the longest is not in the root"},
    {1000, TOP, 512, VK, {1, 1, 0, MOST}, ONE, FREE, 51200000, "VK, A so long that the speed is above the top"},
    {10, TOP, 512, VK, {512, 512, 0, 0}, ONE, FREE, 1810, "VK, equal axes: V/root 2, rounded"},
    {7777, TOP, 512, VK, {513, 512, 0, 0}, ONE, FREE, 1409160, "VK, rounded up"},
    {TOP, TOP, 512, VK, {MOST, -MOST, MOST, MOST}, ONE, FREE, 29560334, "VK, three greatest axes"},
    {10, TOP, 512, VK, {MOST, -MOST, MOST, MOST}, ONE, FREE, 1478, "VK, the least V of such"},
    {99999, TOP, 512, VK, {MOST, MOST - 1, MOST - 2, 0}, ONE, FREE, 14780019, "VK, all but equal"},
    {TOP, TOP, 512, VK, {MOST, 1, 0, 0}, ONE, FREE, 51200000, "VK, one pulse beside the longest"},
    {TOP, TOP, 512, VN, {MOST, -MOST, MOST, -MOST}, ONE, FREE, 51200000, "VN, the greatest"},
    {TOP, TOP, 1, VN, {1, 0, 0, 0}, ONE, FREE, 512000, "one pulse takes 500 us"},
    {TOP, TOP, 1, VK, {1, -1, 1, 0}, ONE, FREE, 512000, "a diagonal of one pulse"},
    {TOP, TOP, 1, VN, {99, 1, 0, 0}, ONE, FREE, 50688000, "99 pulses take 500 us"},
    {TOP, TOP, 1, VN, {100, 1, 0, 0}, ONE, FREE, 51200000, "100 pulses reach the top"},
    {10, TOP, 1, VN, {0, 0, 0, -1}, ONE, FREE, 2560, "one pulse, slow"},
    {5000, 100, 512, VN, {512, 0, 0, 0}, ONE, FREE, 1280000, "long at $"},
    {5000, 100, 512, VN, {511, 0, 0, 0}, ONE, FREE, 25600, "short below $"},
    {100, 5000, 512, VN, {511, 0, 0, 0}, ONE, FREE, 25600, "short, V below B"},
    {5000, 100, 512, VN, {10, 0, -512, 0}, ONE, FREE, 1280000, "the longest axis decides what is short"},
    {5000, 100, 512, VK, {300, 400, 0, 0}, ONE, FREE, 20480, "short, VK: B is corrected, too"},
    {5000, 10, MOST, false, {MOST - 1, 0, 0, 0}, ONE, FREE, 2560, "short up to the greatest $"},
    {5000, 10, MOST, false, {MOST, 0, 0, 0}, ONE, FREE, 1280000, "not short at the greatest $"},
    {1000, TOP, 512, VN, {1000, 0, 0, 0}, 9830400, FREE, 384000, "a factor"},
    {10, TOP, 512, VN, {1000, 0, 0, 0}, FACTOR_MIN, FREE, 26, "the least factor of the least V"},
    {TOP, TOP, 512, VN, {1000, 0, 0, 0}, FACTOR_MAX, FREE, 51200000, "factor and V at most: the top"},
    {TOP, TOP, 1, VK, {300, 400, 0, 0}, FACTOR_MAX, FREE, 51200000, "the factor counts before the correction"},
    {10, TOP, 512, VN, {1000, 0, 0, 0}, 67839, FREE, 26, "rounded down"},
    {10, TOP, 512, VN, {1000, 0, 0, 0}, 67840, FREE, 27, "halves up"},
    {1000, 1500, 512, VN, {100, 0, 0, 0}, FACTOR_MAX, FREE, 384000, "a short one keeps B under a factor"},
    {9000, TOP, 512, VN, {1000, 500, 0, 0}, ONE, {700, TOP, TOP, TOP}, 179200, "VL of the longest axis"},
    {9000, TOP, 512, VN, {1000, 300, 0, 0}, ONE, {TOP, 700, TOP, TOP}, 597333, "VL of a shorter axis: 700*1000/300"},
    {9000, TOP, 512, VN, {1000, 300, 0, 0}, ONE, {TOP, TOP, 10, 10}, 2304000, "VL of an axis that stands"},
    {9000, TOP, 512, VN, {1000, 0, 0, -999}, ONE, {TOP, TOP, TOP, 10}, 2562, "VL of A, backward"},
    {9000, TOP, 512, VN, {1000, 999, 0, 0}, ONE, {9000, 9000, TOP, TOP}, 2304000, "VL that does not touch"},
    {10000, TOP, 512, VK, {3000, 4000, 0, 0}, ONE, {5999, TOP, TOP, TOP}, 2047658, "VL after VK: the lowest counts"},
    {10000, TOP, 512, VK, {3000, 4000, 0, 0}, ONE, {6001, TOP, TOP, TOP}, 2048000, "VL just above what VK leaves"},
    {TOP, TOP, 512, VN, {MOST, -1, 0, 0}, ONE, {TOP, 10, TOP, TOP}, 51200000, "VL of one pulse beside the greatest"},
    {TOP, TOP, 512, VN, {MOST, MOST, MOST, MOST}, FACTOR_MAX, {TOP, TOP, TOP, 10}, 2560, "VL of the greatest"},
    {10, TOP, 512, VN, {1000, 0, 0, 0}, 1, FREE, 1, "never 0"},
    {10, TOP, 512, VN, {1000, 0, 0, 0}, ONE, {0, TOP, TOP, TOP}, 1, "never 0, where an axis is all but forbidden"},
    {TOP, TOP, 512, VN, {1000, 0, 0, 0}, FACTOR_MAX, {199999, TOP, TOP, TOP}, 51199744, "VL holds against the factor"},
};
/* clang-format on */

struct border_case {
    uint32_t brake;
    bool corrected;
    int32_t steps[PATH_AXES];
    bool corrected_after;
    int32_t steps_after[PATH_AXES];
    uint32_t jump[PATH_AXES];
    uint32_t expected;
    const char *what;
};

/* clang-format off */
static const struct border_case borders[] = {
    {TOP, VK, {1, 0, 0, MOST}, VK, {1, 0, 0, -MOST}, {0, 0, 0, 1}, 0, "A, so fast that it must stand"},
    {TOP, VK, {3, 2, 4, 0}, VK, {-6, 8, 8, 0}, {124796, 0, 0, 0}, 31150157, "N is rounded up"},
    {TOP, VK, {1, 1, 8, 0}, VK, {-9, 7, 4, 0}, {111655, 0, 0, 0}, 32932923, "N is rounded up"},
    {TOP, VK, {9, 2, 2, 0}, VK, {0, 2, 6, 0}, {190132, 0, 0, 0}, 51020898, "N is rounded up"},
    {5000, VN, {100, 0, 0, 0}, VN, {100, 0, 0, 0}, {0, 0, 0, 0}, 1280000, "B of the one before"},
    {5000, VN, {100, 0, 0, 0}, VN, {7, 0, 0, 0}, {1, 1, 1, 1}, 1280000, "a straight line has no jump"},
    {TOP, VN, {100, 0, 0, 0}, VN, {0, 100, 0, 0}, {500, 0, 0, 0}, 128000, "a right angle: J of either axis"},
    {TOP, VN, {100, 0, 0, 0}, VN, {0, 100, 0, 0}, {0, 300, 0, 0}, 76800, "a right angle, the other axis"},
    {TOP, VN, {100, 0, 0, 0}, VN, {0, 100, 0, 0}, {500, 300, 0, 0}, 76800, "the lowest counts"},
    {TOP, VN, {100, 0, 0, 0}, VN, {-50, 0, 0, 0}, {500, 0, 0, 0}, 64000, "the way back: J/2"},
    {TOP, VN, {100, 100, 0, 0}, VN, {100, 50, 0, 0}, {0, 100, 0, 0}, 51200, "an axis that slows by half"},
    {TOP, VN, {100, 0, 0, 0}, VN, {100, 1, 0, 0}, {0, 100, 0, 0}, 2560000, "an axis that begins"},
    {10, VN, {100, 0, 0, 0}, VN, {0, 100, 0, 0}, {500, 0, 0, 0}, 2560, "B below that"},
    {600, VN, {100, 0, 0, 0}, VN, {0, 100, 0, 0}, {601, 0, 0, 0}, 153600, "a jump above B"},
    {TOP, VN, {0, 0, -30, 40}, VN, {0, 0, 40, 30}, {0, 0, 100, 200}, 14628, "Z and A"},
    {TOP, VK, {3000, 4000, 0, 0}, VK, {4000, 3000, 0, 0}, {100, 0, 0, 0}, 128000, "VK: 3, 4 to 4, 3"},
    {TOP, VK, {3000, 4000, 0, 0}, VN, {3000, 4000, 0, 0}, {0, 100, 0, 0}, 128000, "VK to VN"},
    {TOP, VK, {1, 1, 0, 0}, VK, {1, -1, 0, 0}, {0, 100, 0, 0}, 18101, "VK, where E is no whole number"},
    {TOP, VK, {0, 0, 0, 9}, VK, {0, 0, 0, -9}, {0, 0, 0, 50}, 6400, "VK with A alone counts A"},
    {TOP, VN, {1, 0, 0, 0}, VN, {0, -MOST, 0, 0}, {10, 0, 0, 0}, 2560, "one pulse and the greatest"},
    {TOP, VK, {MOST, MOST, MOST, 0}, VK, {-MOST, -MOST, -MOST, 0}, {1, 0, 0, 0}, 221, "the greatest, turned in space"},
    {TOP, VK, {MOST, MOST, 0, 0}, VK, {MOST, MOST - 1, 0, 0}, {0, TOP, 0, 0}, 51200000, "the greatest J"},
    {TOP, VN, {MOST, -MOST, MOST, -MOST}, VN, {-MOST, MOST, -MOST, MOST}, {1, 1, 1, 1}, 128, "the least J"},
    {TOP, VN, {MOST, MOST - 1, 0, 0}, VN, {MOST, MOST - 2, 0, 0}, {1, 1, 1, 1}, 51200000, "nearly no change"},
    {TOP, VN, {10, 10, 0, 0}, VN, {10, -10, 0, 0}, {7, 0, 0, 0}, 51200000, "an axis that goes on"},
    {TOP, VK, {3, 4, 0, 100}, VK, {4, 3, 0, -100}, {0, 0, 0, 20}, 128, "A that stands out of the root"},
};
/* clang-format on */

static const struct {
    uint32_t factor;
    uint32_t up;
    uint32_t down;
} factors[] = {
    {ONE, 6963200, 6144000},        {65536, 69632, 65536},          {65537, 69633, 65536},
    {65540, 69636, 65536},          {69905, 74274, 65536},          {69906, 74275, 65537},
    {61680821, 65535872, 57825770}, {61680822, 65535873, 57825771}, {61680941, 65536000, 57825882},
    {65535999, 65536000, 61439999}, {65536000, 65536000, 61440000}, {100000, 106250, 93750},
    {100001, 106251, 93751},        {100007, 106257, 93757},        {100008, 106259, 93758},
};

static struct gve_modal modal;

void setUp(void)
{
    gve_modal_init(&modal);
}

void tearDown(void)
{
}

static struct gve_vector vector_of(bool corrected, const int32_t steps[PATH_AXES])
{
    modal.corrected = corrected;
    return gve_speeds_take(&modal, steps);
}

void test_after_a_reset_settings_are_those_of_the_data_sheet(void)
{
    TEST_ASSERT_EQUAL_UINT32(20, modal.accel);
    TEST_ASSERT_EQUAL_UINT32(1000, modal.speed);
    TEST_ASSERT_EQUAL_UINT32(512, modal.short_pulses);
    TEST_ASSERT_EQUAL_UINT32(200000, modal.brake);
    TEST_ASSERT_EQUAL_UINT32(1, modal.pause_ms);
    TEST_ASSERT_FALSE(modal.corrected);
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        TEST_ASSERT_EQUAL_UINT32(200000, modal.limit[axis]);
        TEST_ASSERT_EQUAL_UINT32(0, modal.jump[axis]);
    }
}

void test_a_vector_keeps_what_it_was_entered_with(void)
{
    static const int32_t steps[PATH_AXES] = {1, -2, 3, -MOST};
    modal.accel = 8000;
    modal.speed = 77;
    modal.brake = 88;
    struct gve_vector vector = vector_of(true, steps);
    TEST_ASSERT_EQUAL_INT32_ARRAY(steps, vector.steps, PATH_AXES);
    TEST_ASSERT_EQUAL_UINT32(8000, vector.accel);
    TEST_ASSERT_EQUAL_UINT32(77, vector.speed);
    TEST_ASSERT_EQUAL_UINT32(88, vector.brake);
    TEST_ASSERT_TRUE(vector.corrected);
    TEST_ASSERT_FALSE(vector.is_short);
}

void test_what_stands_after_the_numbers_of_the_axes_does_not_count(void)
{
    static const int32_t steps[PATH_AXES + 1] = {1000, 0, 0, 0, 5};
    static const uint32_t limit[PATH_AXES + 1] = {TOP, TOP, TOP, TOP, 0};
    struct gve_vector vector = vector_of(false, steps);
    TEST_ASSERT_EQUAL_UINT32(1000, vector.speed);
    TEST_ASSERT_EQUAL_UINT32(256000, gve_speeds_limit(&vector, ONE, limit));
}

void test_the_limit_of_a_vector_is_that_of_the_formula(void)
{
    for (size_t i = 0; i < COUNT_OF(limits); i++) {
        const struct limit_case *c = &limits[i];
        modal.speed = c->speed;
        modal.brake = c->brake;
        modal.short_pulses = c->short_pulses;
        struct gve_vector vector = vector_of(c->corrected, c->steps);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(c->expected, gve_speeds_limit(&vector, c->factor, c->limit), c->what);
    }
}

void test_the_border_of_two_vectors_is_that_of_the_formula(void)
{
    for (size_t i = 0; i < COUNT_OF(borders); i++) {
        const struct border_case *c = &borders[i];
        modal.brake = c->brake;
        struct gve_vector before = vector_of(c->corrected, c->steps);
        modal.brake = 10; /* of the one after it has no part in this */
        struct gve_vector after = vector_of(c->corrected_after, c->steps_after);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(c->expected, gve_speeds_border(&before, &after, c->jump), c->what);
    }
}

void test_without_correction_the_extent_is_the_longest_axis(void)
{
    struct gve_vector vector = vector_of(false, (const int32_t[]){3, -4, 0, 2});
    TEST_ASSERT_EQUAL_UINT64(16, gve_speeds_extent2(&vector));
    vector = vector_of(false, (const int32_t[]){-MOST, 1, 1, MOST});
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(4611686014132420609), gve_speeds_extent2(&vector));
}

void test_with_correction_the_extent_is_the_way_of_x_y_and_z(void)
{
    struct gve_vector vector = vector_of(true, (const int32_t[]){3, -4, 12, 1000});
    TEST_ASSERT_EQUAL_UINT64(169, gve_speeds_extent2(&vector));
    vector = vector_of(true, (const int32_t[]){-MOST, MOST, MOST, 0});
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(13835058042397261827), gve_speeds_extent2(&vector));
}

void test_a_vector_of_a_alone_is_as_long_as_a(void)
{
    struct gve_vector vector = vector_of(true, (const int32_t[]){0, 0, 0, -7});
    TEST_ASSERT_EQUAL_UINT64(49, gve_speeds_extent2(&vector));
}

void test_a_factor_changes_by_a_sixteenth_halves_up_and_stays_in_its_range(void)
{
    for (size_t i = 0; i < COUNT_OF(factors); i++) {
        TEST_ASSERT_EQUAL_UINT32(factors[i].up, gve_factor_up(factors[i].factor));
        TEST_ASSERT_EQUAL_UINT32(factors[i].down, gve_factor_down(factors[i].factor));
    }
}

void test_ten_times_up_and_ten_times_down_rounds_each_time(void)
{
    uint32_t factor = ONE;
    for (unsigned i = 0; i < 10; i++) {
        factor = gve_factor_up(factor);
    }
    TEST_ASSERT_EQUAL_UINT32(12016260, factor);
    for (unsigned i = 0; i < 10; i++) {
        factor = gve_factor_down(factor);
    }
    TEST_ASSERT_EQUAL_UINT32(6302054, factor);
}
