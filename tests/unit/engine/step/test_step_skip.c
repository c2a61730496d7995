#include "base_tick.h"
#include "base_wide.h"
#include "step_scale.h"
#include "step_skip.h"
#include "unity.h"

/* Skipping pulses leads to the same place as walking along them. */

enum {
    PULSES = 400
};

static const uint32_t speeds[] = {26000, 33333, 50000, 64000, 99999, 200000, 333333, 1000000};
static const int32_t accels[] = {0, 1000, -1000, 1000000, -1000000, 8000000, -8000000};

static unsigned skips_tried;
static unsigned skips_made;

void setUp(void)
{
    skips_tried = 0;
    skips_made = 0;
}

void tearDown(void)
{
}

static struct step_generator generator_at(uint32_t speed, int32_t accel)
{
    struct step_segment segment = {
        .slope = speed * STEP_SLOPE_PER_SPEED,
        .accel = accel * (int32_t)STEP_ACCEL_PER_ACCEL,
        .tick = UINT32_MAX - 20000U,
        .pace_ticks = accel == 0 ? TICK_HZ / speed : 0U,
        .steps = PULSES,
    };
    struct step_generator generator;
    step_generator_start(&generator, segment.tick);
    step_generator_aim(&segment, TICK_HZ / speed);
    step_generator_load(&generator, &segment);
    return generator;
}

static void assert_same(const struct step_generator *walked, const struct step_generator *skipped)
{
    TEST_ASSERT_EQUAL_UINT32(walked->tick, skipped->tick);
    TEST_ASSERT_EQUAL_HEX64(walked->residual, skipped->residual);
    TEST_ASSERT_EQUAL_HEX64(walked->slope, skipped->slope);
    TEST_ASSERT_EQUAL_INT32(walked->accel, skipped->accel);
    TEST_ASSERT_EQUAL_UINT32(walked->pace_ticks, skipped->pace_ticks);
    TEST_ASSERT_EQUAL_HEX64(walked->pace_rest, skipped->pace_rest);
}

static void assert_skips_from(const struct step_generator *from)
{
    struct step_generator walked = *from;
    for (uint32_t pulses = 1; pulses <= STEP_SKIP_MAX; pulses++) {
        struct step_generator skipped = *from;
        (void)step_generator_next(&walked);
        skips_tried++;
        if (step_skip(&skipped, pulses)) {
            skips_made++;
            assert_same(&walked, &skipped);
            TEST_ASSERT_EQUAL_UINT32((walked.tick - from->tick) / pulses, skipped.interval);
        } else {
            TEST_ASSERT_EQUAL_MEMORY(from, &skipped, sizeof skipped);
        }
    }
}

/* The steepest ramp down from 26 000 steps/s has 42 pulses. */
static uint32_t pulses_of(uint32_t speed, int32_t accel)
{
    uint64_t pulses = accel < 0 ? (uint64_t)speed * speed / (2U * (uint64_t)-(int64_t)accel) : PULSES;
    return pulses < PULSES ? (uint32_t)pulses - STEP_SKIP_MAX - 2U : PULSES;
}

static void walk(uint32_t speed, int32_t accel)
{
    struct step_generator generator = generator_at(speed, accel);
    for (uint32_t i = 0; i < pulses_of(speed, accel); i++) {
        assert_skips_from(&generator);
        (void)step_generator_next(&generator);
    }
}

void test_any_number_of_pulses_of_cruises_and_ramps_is_skipped_as_if_walked(void)
{
    for (unsigned s = 0; s < sizeof speeds / sizeof speeds[0]; s++) {
        for (unsigned a = 0; a < sizeof accels / sizeof accels[0]; a++) {
            walk(speeds[s], accels[a]);
        }
    }

    TEST_ASSERT_GREATER_THAN_UINT(skips_tried / 10U * 9U, skips_made);
}

void test_pulses_that_come_slowly_are_not_skipped(void)
{
    struct step_generator generator = generator_at(24000, 0);
    struct step_generator before = generator;

    TEST_ASSERT_FALSE(step_skip(&generator, 2));

    TEST_ASSERT_EQUAL_MEMORY(&before, &generator, sizeof before);
}

/* 840 ticks for two pulses; the position after that is just half a tick's travel off. */
static bool skips_to(uint64_t residual, uint64_t slope)
{
    struct step_generator generator = {.slope = slope, .residual = residual + 2U * STEP_QUANTA - 840U * slope};
    return step_skip(&generator, 2);
}

void test_where_two_ticks_would_do_none_is_found(void)
{
    const uint64_t slope = 2U * STEP_QUANTA / 840U / 4U * 4U;

    TEST_ASSERT_FALSE(skips_to(slope / 2U, slope));
    TEST_ASSERT_FALSE(skips_to(0U - slope / 2U, slope));
    TEST_ASSERT_TRUE(skips_to(slope / 4U, slope));
    TEST_ASSERT_TRUE(skips_to(0U - slope / 4U, slope));
}
