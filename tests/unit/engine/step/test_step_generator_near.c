#include "base_tick.h"
#include "base_wide.h"
#include "step_generator.h"
#include "step_scale.h"
#include "unity.h"

/* What tests/proofs leaves open: that the search of a pulse ends before its corrections are used up. Ramps over the
 * whole range, up from a speed and down to it, as far as they stay below the top speed. */
enum {
    PULSES = 400
};

static const uint32_t speeds[] = {1, 2, 3, 5, 8, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 16000, 50000, 200000};

static uint64_t pulses_seen;

void setUp(void)
{
}

void tearDown(void)
{
}

static uint32_t root(uint64_t value)
{
    return (uint32_t)wide_root_nearest((struct wide){.low = value});
}

static uint32_t lower(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* The speed after so many steps from a slower one. */
static uint32_t speed_after(uint32_t speed, uint32_t accel, uint32_t steps)
{
    return root((uint64_t)speed * speed + (uint64_t)2 * accel * steps);
}

static void assert_near(const struct step_generator *generator)
{
    TEST_ASSERT_TRUE_MESSAGE(step_generator_is_near(generator->residual, generator->slope), "the search gave up");
    TEST_ASSERT_TRUE_MESSAGE(generator->slope < STEP_QUANTA / 2U, "the slope is that of no speed");
    TEST_ASSERT_TRUE_MESSAGE(generator->interval <= STEP_INTERVAL_TICKS_MAX, "an interval too long");
    pulses_seen++;
}

/* Looks at the pulses of a segment that begins at tick 0. */
static void walk(struct step_segment segment, uint32_t guess_ticks, uint32_t pulses)
{
    struct step_generator generator;
    step_generator_start(&generator, 0);
    step_generator_aim(&segment, guess_ticks);
    step_generator_load(&generator, &segment);
    assert_near(&generator);
    for (uint32_t made = 1; made < pulses; made++) {
        (void)step_generator_next(&generator);
        TEST_ASSERT_TRUE_MESSAGE(generator.interval >= 1U, "no interval");
        assert_near(&generator);
    }
}

static void speed_up(uint32_t speed, uint32_t accel)
{
    struct step_segment segment = {
        .slope = speed * STEP_SLOPE_PER_SPEED,
        .accel = (int32_t)(accel * STEP_ACCEL_PER_ACCEL),
    };
    walk(segment, lower(TICK_HZ / speed, root((uint64_t)2 * TICK_HZ * TICK_HZ / accel)), PULSES);
}

/* Laid from its slow end, a whole step; the products wrap. */
static void brake(uint32_t speed, uint32_t accel)
{
    uint64_t ticks = (uint64_t)(speed_after(speed, accel, PULSES) - speed) * TICK_HZ / accel;
    uint64_t fall = (uint64_t)accel * STEP_ACCEL_PER_ACCEL;
    uint64_t slope = speed * STEP_SLOPE_PER_SPEED;
    uint64_t rest;
    uint64_t steps = wide_divide(wide_multiply(ticks, slope + fall * ticks), STEP_QUANTA, &rest);
    struct step_segment segment = {
        .residual = STEP_QUANTA - rest,
        .slope = slope + 2U * fall * ticks,
        .accel = -(int32_t)(accel * STEP_ACCEL_PER_ACCEL),
    };
    walk(segment, (uint32_t)(rest / segment.slope), (uint32_t)steps);
}

static void over_all_ramps(void (*ramp)(uint32_t speed, uint32_t accel))
{
    pulses_seen = 0;
    for (unsigned i = 0; i < sizeof speeds / sizeof speeds[0]; i++) {
        for (uint32_t accel = 1; accel <= STEP_ACCEL_MAX; accel += accel / 16U + 1U) {
            if (speed_after(speeds[i], accel, PULSES) < STEP_SPEED_MAX) {
                ramp(speeds[i], accel);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT64(1000000, pulses_seen);
}

void test_every_pulse_of_a_ramp_up_is_near_a_whole_step(void)
{
    over_all_ramps(speed_up);
}

void test_every_pulse_of_a_ramp_down_is_near_a_whole_step(void)
{
    over_all_ramps(brake);
}
