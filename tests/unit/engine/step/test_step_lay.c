#include "step_lay.h"
#include "step_scale.h"
#include "unity.h"

/* What one call lays: up to its count, and none after the first pulse that is due at the tick that was asked for. */

enum {
    INTERVAL = 8400,
    PLACES = 8,
    HIGH = 42,
};

static struct hal_step_pulse pulses[PLACES];
static struct step_generator generator;

void setUp(void)
{
}

void tearDown(void)
{
}

static struct hal_step_room begin(int32_t accel, uint32_t until)
{
    struct step_segment segment = {
        .slope = STEP_QUANTA / INTERVAL,
        .accel = accel,
        .pace_ticks = accel == 0 ? INTERVAL : 0,
        .steps = 100,
    };
    step_generator_start(&generator, 0);
    step_generator_aim(&segment, INTERVAL);
    step_generator_load(&generator, &segment);
    return (struct hal_step_room){.pulse = pulses, .count = PLACES, .until_tick = until, .high_ticks = HIGH};
}

static void assert_laid(int32_t accel)
{
    for (unsigned wanted = 1; wanted <= PLACES; wanted++) {
        struct hal_step_room room = begin(accel, 0);
        struct step_generator other = generator;
        uint32_t tick = 0;
        for (unsigned i = 0; i < wanted; i++) {
            tick = step_generator_next(&other);
        }
        room.until_tick = tick;
        TEST_ASSERT_EQUAL_UINT(wanted, step_lay(&generator, &room, 0, PLACES));
        TEST_ASSERT_EQUAL_UINT32(tick, pulses[wanted - 1U].rise_tick);
        TEST_ASSERT_EQUAL_UINT32(tick + HIGH, pulses[wanted - 1U].fall_tick);
        TEST_ASSERT_EQUAL_UINT32(tick, generator.tick);
    }
}

void test_no_pulse_of_a_cruise_is_laid_after_the_first_that_is_due(void)
{
    assert_laid(0);
}

void test_no_pulse_of_a_ramp_is_laid_after_the_first_that_is_due(void)
{
    assert_laid(2000 * (int32_t)STEP_ACCEL_PER_ACCEL);
    assert_laid(-2000 * (int32_t)STEP_ACCEL_PER_ACCEL);
}

void test_no_more_pulses_are_laid_than_asked_for(void)
{
    struct hal_step_room room = begin(0, UINT32_MAX / 4U);

    TEST_ASSERT_EQUAL_UINT(3, step_lay(&generator, &room, 2, 3));

    TEST_ASSERT_EQUAL_UINT32(generator.tick, pulses[4].rise_tick);
}
