#include "motion_point.h"
#include "plan_walk.h"
#include "step_scale.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static uint64_t lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static void begin(uint32_t start_speed, uint32_t speed, uint32_t accel, uint64_t steps, uint64_t start_tick)
{
    const struct motion_order order = {
        .section = {{steps, speed, accel}},
        .start_speed_steps_per_s = start_speed,
        .sections = 1,
    };
    walk_begin(&order, start_tick);
}

/* At a whole step the square of the speed is that of the first ramp, of the last one or of the top speed, whichever is
 * lowest. */
static uint64_t speed2_at(uint64_t pulse)
{
    const struct motion_section *section = &plan.order.section[0];
    uint64_t start = lower(plan.order.start_speed_steps_per_s, section->speed_steps_per_s);
    uint64_t nearest_end = lower(pulse, section->steps - pulse);
    return lower(start * start + 2U * (uint64_t)section->accel_steps_per_s2 * nearest_end,
                 motion_square(section->speed_steps_per_s));
}

static void assert_points(uint64_t steps)
{
    for (uint64_t k = 1; k <= steps; k++) {
        TEST_ASSERT_TRUE(walk_on());
        struct motion_point point = motion_point_of(&cursor, now);
        TEST_ASSERT_EQUAL_UINT64(k, point.step);
        TEST_ASSERT_EQUAL_UINT64(speed2_at(k), point.speed2);
    }
}

void test_the_square_of_the_speed_is_recovered_at_every_pulse_of_every_extreme_move(void)
{
    const uint32_t start_speeds[] = {1, 2, 1999, 2000};
    const uint32_t speeds[] = {1, 2000, 15999, 16000};
    const uint32_t accels[] = {1, 2, 59999, 60000};
    const uint64_t steps[] = {1, 2, 3, 999, 3000};
    for (unsigned i = 0; i < 4U * 4U * 4U * 5U; i++) {
        begin(start_speeds[i % 4U], speeds[i / 4U % 4U], accels[i / 16U % 4U], steps[i / 64U],
              UINT64_C(0x123456789ABCDEF) * i >> 3U);
        assert_points(steps[i / 64U]);
    }
}

void test_the_square_of_the_speed_is_recovered_on_the_longest_ramps(void)
{
    begin(1, 16000, 60000, 10000, 0);
    assert_points(10000);
    begin(1, 16000, 1, 100000, 5);
    assert_points(100000);
}

void test_the_square_of_the_speed_is_recovered_at_the_most_that_the_generator_is_built_for(void)
{
    begin(1, MOTION_SPEED_MAX, STEP_ACCEL_MAX, 30000, 77);

    assert_points(30000);
}

/* 84 MHz / 13 is 6461538 + 6/13 ticks, and three of them 19384615 + 5/13. */
void test_the_time_of_a_point_is_exact_to_the_fraction(void)
{
    begin(13, 13, 1000, 10, 1000);
    TEST_ASSERT_TRUE(walk_on());
    TEST_ASSERT_TRUE(walk_on());
    TEST_ASSERT_TRUE(walk_on());

    struct motion_point point = motion_point_of(&cursor, now);

    TEST_ASSERT_EQUAL_UINT64(1000 + 19384615, point.time.ticks);
    TEST_ASSERT_UINT32_WITHIN(1, UINT32_C(1651910498), point.time.fraction);
}

/* 2/3 of a tick: the pulse's tick is the one after it. */
void test_the_time_of_a_point_may_lie_before_the_tick_of_its_pulse(void)
{
    begin(9, 9, 1000, 10, 0);
    TEST_ASSERT_TRUE(walk_on());
    TEST_ASSERT_TRUE(walk_on());

    struct motion_point point = motion_point_of(&cursor, now);

    TEST_ASSERT_EQUAL_UINT32(18666667, cursor.generator.tick);
    TEST_ASSERT_EQUAL_UINT64(18666666, point.time.ticks);
    TEST_ASSERT_UINT32_WITHIN(1, UINT32_C(2863311530), point.time.fraction);
}

void test_the_time_of_a_point_is_the_units_time_across_the_wrap_of_the_counter(void)
{
    const uint64_t start = (UINT64_C(9) << 32) - 5U;
    begin(16000, 16000, 1000, 10, start);
    TEST_ASSERT_TRUE(walk_on());

    TEST_ASSERT_EQUAL_UINT64(start + 5250U, motion_point_of(&cursor, start).time.ticks);
    TEST_ASSERT_EQUAL_UINT64(start + 5250U, motion_point_of(&cursor, start + 9999U).time.ticks);
}
