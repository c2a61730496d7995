#include "base_tick.h"
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

static struct hal_step_room begin_with(int32_t accel, uint32_t interval, uint32_t until)
{
    struct step_segment segment = {
        .slope = STEP_QUANTA / interval,
        .accel = accel,
        .pace_ticks = accel == 0 ? interval : 0,
        .steps = 100,
    };
    step_generator_start(&generator, 0);
    step_generator_aim(&segment, interval);
    step_generator_load(&generator, &segment);
    return (struct hal_step_room){.pulse = pulses, .count = PLACES, .until_tick = until, .high_ticks = HIGH};
}

static struct hal_step_room begin(int32_t accel, uint32_t until)
{
    return begin_with(accel, INTERVAL, until);
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

/* Laid in pieces, each pulse and what the generator then stands on are those that it makes one at a time. */
static void assert_laid_as_made(int32_t accel, uint32_t interval, unsigned count)
{
    struct hal_step_room room = begin_with(accel * (int32_t)STEP_ACCEL_PER_ACCEL, interval, INT32_MAX);
    struct step_generator other = generator;
    for (unsigned laid = 0; laid < count; laid += PLACES) {
        TEST_ASSERT_EQUAL_UINT(PLACES, step_lay(&generator, &room, 0, PLACES));
        for (unsigned i = 0; i < PLACES; i++) {
            TEST_ASSERT_EQUAL_UINT32(step_generator_next(&other), pulses[i].rise_tick);
        }
        TEST_ASSERT_EQUAL_UINT64(other.residual, generator.residual);
        TEST_ASSERT_EQUAL_UINT64(other.slope, generator.slope);
        TEST_ASSERT_EQUAL_UINT32(other.interval, generator.interval);
    }
}

void test_pulses_are_laid_as_the_generator_makes_them_on_ramps_of_all_kinds(void)
{
    for (uint32_t interval = 84; interval < 100000; interval += 1U + interval / 50U) {
        const uint64_t speed = TICK_HZ / interval;
        for (int32_t accel = 100; accel <= 6000000; accel = accel * 3 / 2) {
            const uint64_t stop = speed * speed / (4U * (uint64_t)accel);
            assert_laid_as_made(accel, interval, 48);
            if (stop > 2U * PLACES) {
                assert_laid_as_made(-accel, interval, stop < 56U ? (unsigned)stop - PLACES : 48U);
            }
        }
    }
}

void test_pulses_are_laid_as_the_generator_makes_them_in_a_cruise(void)
{
    assert_laid_as_made(0, INTERVAL, 48);
    assert_laid_as_made(0, 97, 48);
}

/* Every second interval is a tick longer. */
void test_after_a_cruise_the_generator_stands_on_its_last_interval(void)
{
    for (unsigned count = 1; count <= PLACES; count++) {
        struct hal_step_room room = begin(0, INT32_MAX);
        generator.pace_rest = generator.slope / 2U;
        struct step_generator other = generator;
        TEST_ASSERT_EQUAL_UINT(count, step_lay(&generator, &room, 0, count));
        for (unsigned i = 0; i < count; i++) {
            TEST_ASSERT_EQUAL_UINT32(step_generator_next(&other), pulses[i].rise_tick);
        }
        TEST_ASSERT_EQUAL_UINT32(other.interval, generator.interval);
    }
}

void test_no_more_pulses_are_laid_than_asked_for(void)
{
    struct hal_step_room room = begin(0, UINT32_MAX / 4U);

    TEST_ASSERT_EQUAL_UINT(3, step_lay(&generator, &room, 2, 3));

    TEST_ASSERT_EQUAL_UINT32(generator.tick, pulses[4].rise_tick);
}

/* Around half a tick's travel on both sides, with all that the low words may add. */
static void assert_sure(uint64_t slope)
{
    static const uint64_t lows[] = {0, 1, UINT32_MAX / 2U, UINT32_MAX / 2U + 1U, UINT32_MAX - 1U, UINT32_MAX};
    uint64_t half = slope >> 33U;
    for (uint64_t off = 0; off < 6; off++) {
        for (unsigned i = 0; i < sizeof lows / sizeof lows[0]; i++) {
            uint64_t residual = ((half + off - 3U) << 32U) + lows[i];
            if (step_lay_is_surely_near(residual, slope)) {
                TEST_ASSERT_TRUE(step_generator_is_near(residual, slope));
            }
            if (step_lay_is_surely_near(0U - residual, slope)) {
                TEST_ASSERT_TRUE(step_generator_is_near(0U - residual, slope));
            }
        }
    }
}

void test_what_the_high_words_say_is_near_is_near(void)
{
    for (uint64_t speed = 1; speed < 20; speed++) {
        assert_sure(speed << 32U);
        assert_sure((speed << 32U) + 1U);
        assert_sure((speed << 32U) + UINT32_MAX);
        assert_sure((speed << 52U) + speed);
    }
    TEST_ASSERT_TRUE(step_lay_is_surely_near(0, UINT64_C(4) << 32U));
}
