#include "base_tick.h"
#include "base_wide.h"
#include "step_generator.h"
#include "step_scale.h"
#include "unity.h"

/* Motion from tick 0 on whole numbers of steps/s and steps/s^2: 2*f^2*x(T) = T * (2*f*v + a*T). */
struct motion {
    uint32_t start_tick;
    uint32_t speed_steps_per_s;
    int32_t accel_steps_per_s2;
};

/* A pulse is due when the position, in 1 / (10000 * 2 * f^2) steps, is between the two: 51/100 tick to either side. */
enum {
    TICK_PARTS = 100,
    TOLERANCE_PARTS = 51
};

#define STEP_PARTS (UINT64_C(2) * TICK_PARTS * TICK_PARTS * TICK_HZ)

static struct step_generator generator;
static bool loaded; /* and its first pulse not yet looked at */

void setUp(void)
{
}

void tearDown(void)
{
}

static void load(struct step_segment segment, uint32_t interval_ticks)
{
    step_generator_aim(&segment, interval_ticks);
    step_generator_load(&generator, &segment);
    loaded = true;
}

static uint32_t next_pulse(void)
{
    uint32_t tick = loaded ? generator.tick : step_generator_next(&generator);
    loaded = false;
    return tick;
}

static uint64_t slope_of(uint32_t speed_steps_per_s)
{
    return speed_steps_per_s * STEP_SLOPE_PER_SPEED;
}

static struct step_segment segment_of(const struct motion *motion)
{
    return (struct step_segment){
        .slope = slope_of(motion->speed_steps_per_s),
        .accel = motion->accel_steps_per_s2 * (int32_t)STEP_ACCEL_PER_ACCEL,
        .tick = motion->start_tick,
        .pace_ticks = motion->accel_steps_per_s2 == 0 ? TICK_HZ / motion->speed_steps_per_s : 0U,
        .steps = 1,
    };
}

static void begin(const struct motion *motion, uint32_t interval_ticks)
{
    step_generator_start(&generator, motion->start_tick);
    load(segment_of(motion), interval_ticks);
}

/* The position after so many hundredths of a tick. */
static struct wide position_after(const struct motion *motion, uint64_t parts)
{
    uint64_t rise =
        parts * (uint64_t)(motion->accel_steps_per_s2 < 0 ? -motion->accel_steps_per_s2 : motion->accel_steps_per_s2);
    uint64_t start = UINT64_C(2) * TICK_PARTS * TICK_HZ * motion->speed_steps_per_s;
    return wide_multiply(parts, motion->accel_steps_per_s2 < 0 ? start - rise : start + rise);
}

static void assert_pulse_at(const struct motion *motion, uint64_t pulse, uint64_t tick)
{
    struct wide due = wide_multiply(pulse * TICK_HZ, STEP_PARTS);
    struct wide early = position_after(motion, tick * TICK_PARTS - TOLERANCE_PARTS);
    struct wide late = position_after(motion, tick * TICK_PARTS + TOLERANCE_PARTS);
    TEST_ASSERT_TRUE_MESSAGE(wide_is_at_least(due, early), "the pulse is late");
    TEST_ASSERT_TRUE_MESSAGE(wide_is_at_least(late, due), "the pulse is early");
}

/* Makes `pulses` pulses and looks at each; the ticks are counted in 64 bits, across the wraps of the counter. */
static void assert_exact(const struct motion *motion, uint64_t pulses)
{
    uint64_t tick = 0;
    uint32_t last = motion->start_tick;
    for (uint64_t k = 1; k <= pulses; k++) {
        uint32_t next = next_pulse();
        tick += next - last;
        last = next;
        assert_pulse_at(motion, k, tick);
    }
}

static void assert_exact_ramp(const struct motion *motion, uint32_t first_interval_ticks, uint64_t pulses)
{
    begin(motion, first_interval_ticks);
    assert_exact(motion, pulses);
}

void test_a_new_generator_stands_at_its_tick(void)
{
    step_generator_start(&generator, 4711);

    TEST_ASSERT_EQUAL_UINT32(4711, generator.tick);
}

void test_the_tick_of_a_pulse_is_returned_and_kept(void)
{
    const struct motion motion = {.speed_steps_per_s = 1000};
    begin(&motion, 84000);

    TEST_ASSERT_EQUAL_UINT32(84000, next_pulse());
    TEST_ASSERT_EQUAL_UINT32(84000, generator.tick);
}

void test_the_interval_is_the_way_from_the_pulse_before(void)
{
    const struct motion motion = {.speed_steps_per_s = 16000};
    begin(&motion, 5250);
    (void)next_pulse();

    (void)next_pulse();

    TEST_ASSERT_EQUAL_UINT32(5250, generator.interval);
}

void test_a_ramp_may_tell_what_the_interval_before_it_would_have_been(void)
{
    struct step_segment ramp = segment_of(&(struct motion){.speed_steps_per_s = 1000, .accel_steps_per_s2 = -1000});
    ramp.tick = 500000000;
    step_generator_start(&generator, 0);
    step_generator_load(&generator, &ramp);
    TEST_ASSERT_EQUAL_UINT32(500000000, generator.interval);

    ramp.pace_ticks = 84000;
    step_generator_start(&generator, 0);
    step_generator_load(&generator, &ramp);

    TEST_ASSERT_EQUAL_UINT32(84000, generator.interval);
    TEST_ASSERT_EQUAL_UINT32(500084042, step_generator_next(&generator));
}

void test_constant_speed_does_not_drift_over_ten_million_pulses(void)
{
    const uint32_t speed = 15999;
    const struct motion motion = {.start_tick = UINT32_MAX - 77U, .speed_steps_per_s = speed};
    begin(&motion, TICK_HZ / speed);
    uint64_t tick = 0;
    uint32_t last = motion.start_tick;
    uint64_t wrong = 0;

    for (uint64_t k = 1; k <= 10000000; k++) {
        uint32_t next = next_pulse();
        tick += next - last;
        last = next;
        uint64_t nearest = (2U * k * TICK_HZ + speed) / (2U * speed);
        wrong += tick != nearest ? 1U : 0U;
    }

    TEST_ASSERT_EQUAL_UINT64(0, wrong);
}

void test_the_slowest_speed_is_exact_across_many_wraps_of_the_counter(void)
{
    const struct motion motion = {.start_tick = 99, .speed_steps_per_s = 1};
    begin(&motion, TICK_HZ);

    for (uint32_t k = 1; k <= 1000; k++) {
        TEST_ASSERT_EQUAL_UINT32(99U + k * TICK_HZ, next_pulse());
    }
}

void test_the_longest_interval_is_found(void)
{
    struct step_segment segment = {.slope = STEP_QUANTA / STEP_INTERVAL_TICKS_MAX + 1U, .steps = 1};
    step_generator_start(&generator, 0);
    load(segment, STEP_INTERVAL_TICKS_MAX - 1000U);

    TEST_ASSERT_UINT32_WITHIN(1, STEP_INTERVAL_TICKS_MAX, next_pulse());
}

void test_ramps_up_at_the_corners_of_the_language_are_exact(void)
{
    const uint32_t speeds[] = {1, 2, 100, 2000};
    const int32_t accels[] = {1, 2, 59999, 60000};
    for (unsigned s = 0; s < 4; s++) {
        for (unsigned a = 0; a < 4; a++) {
            const struct motion motion = {UINT32_MAX / 2U + s, speeds[s], accels[a]};
            assert_exact_ramp(&motion, TICK_HZ / (speeds[s] + 200U), 2000);
        }
    }
}

void test_a_ramp_up_with_the_most_that_the_generator_is_built_for_is_exact(void)
{
    const struct motion motion = {.speed_steps_per_s = 1, .accel_steps_per_s2 = (int32_t)STEP_ACCEL_MAX};

    assert_exact_ramp(&motion, TICK_HZ / 4000U, 9999);
}

void test_ramps_down_at_the_corners_of_the_language_are_exact(void)
{
    const struct motion gentle = {.speed_steps_per_s = 100, .accel_steps_per_s2 = -1};
    const struct motion steep = {.speed_steps_per_s = 16000, .accel_steps_per_s2 = -60000};
    const struct motion steepest = {0, STEP_SPEED_MAX, -(int32_t)STEP_ACCEL_MAX};

    assert_exact_ramp(&gentle, TICK_HZ / 100U, 4999);
    assert_exact_ramp(&steep, TICK_HZ / 16000U, 2133);
    assert_exact_ramp(&steepest, TICK_HZ / STEP_SPEED_MAX, 9999);
}

/* Nearly from a stand: there the intervals change most from one to the next. The first takes 0.48 million ticks. */
void test_the_first_pulses_from_nearly_a_stand_are_found_from_a_guess_half_or_twice_as_long(void)
{
    const struct motion motion = {.speed_steps_per_s = 1, .accel_steps_per_s2 = 60000};
    const uint32_t guesses[] = {240000, 480000, 960000};
    for (unsigned i = 0; i < sizeof guesses / sizeof guesses[0]; i++) {
        assert_exact_ramp(&motion, guesses[i], 50);
    }
}

/* 301^2 = 1 + 2 * 45300: a single step, or two with half the acceleration, from 301 steps/s to 1. */
void test_the_last_pulses_down_to_nearly_a_stand_are_exact(void)
{
    const struct motion one = {.speed_steps_per_s = 301, .accel_steps_per_s2 = -45300};
    const struct motion two = {.speed_steps_per_s = 301, .accel_steps_per_s2 = -22650};

    assert_exact_ramp(&one, TICK_HZ / 200U, 1);
    assert_exact_ramp(&two, TICK_HZ / 300U, 2);
}

/* A cruise at 1000 steps/s, then from `corner_ticks` on a ramp, which comes into force after pulse 5. The ideal curve
 * after the corner is that of a ramp alone whose tick 0 is the corner. */
static void assert_exact_after_corner(uint32_t corner_ticks)
{
    const struct motion cruise = {.speed_steps_per_s = 1000};
    struct step_segment ramp = segment_of(&(struct motion){corner_ticks, 1000, 60000});
    begin(&cruise, 84000);
    for (unsigned k = 1; k <= 5; k++) {
        (void)next_pulse();
    }
    ramp.residual = slope_of(1000) * corner_ticks - 5U * STEP_QUANTA;

    load(ramp, 84000);

    /* Six steps from the start are 6 - corner * 1000 / f from the corner; 0.1 step in the middle of the ramp. */
    uint32_t tick = next_pulse();
    int64_t parts = ((int64_t)tick - corner_ticks) * TICK_PARTS;
    const struct motion after = {.speed_steps_per_s = 1000, .accel_steps_per_s2 = 60000};
    struct wide distance = wide_multiply((UINT64_C(6) * 84000U - corner_ticks) * 1000U, STEP_PARTS);
    TEST_ASSERT_TRUE(wide_is_at_least(distance, position_after(&after, (uint64_t)(parts - TOLERANCE_PARTS))));
    TEST_ASSERT_TRUE(wide_is_at_least(position_after(&after, (uint64_t)(parts + TOLERANCE_PARTS)), distance));
}

void test_a_segment_that_begins_after_the_present_pulse_is_exact(void)
{
    assert_exact_after_corner(5 * 84000 + 1);
    assert_exact_after_corner(5 * 84000 + 41999);
    assert_exact_after_corner(5 * 84000 + 83900);
}

void test_a_segment_that_begins_before_the_present_pulse_is_exact(void)
{
    assert_exact_after_corner(5 * 84000 - 1);
    assert_exact_after_corner(5 * 84000 - 3);
}

void test_a_segment_that_begins_on_the_present_pulse_is_exact(void)
{
    assert_exact_after_corner(5 * 84000);
}

/* Two ramps that touch: what follows is the same from any pulse on. */
void test_a_segment_is_joined_on_any_of_its_pulses(void)
{
    const struct motion motion = {.speed_steps_per_s = 700, .accel_steps_per_s2 = 60000};
    struct step_segment segment = segment_of(&motion);
    step_generator_aim(&segment, TICK_HZ / 700U);
    begin(&motion, TICK_HZ / 700U);
    for (uint32_t made = 1; made <= 100; made++) {
        (void)next_pulse();
        struct step_generator joined = generator;
        joined.residual = 0;
        joined.slope = 0;
        joined.accel = 1;
        step_generator_join(&joined, &segment, made);
        TEST_ASSERT_EQUAL_HEX64(generator.residual, joined.residual);
        TEST_ASSERT_EQUAL_HEX64(generator.slope, joined.slope);
        TEST_ASSERT_EQUAL_INT32(generator.accel, joined.accel);
        TEST_ASSERT_EQUAL_UINT32(generator.tick, joined.tick);
    }
}

/* A slope of 2^40 loses ten digits in the division: half of it, and a little more, is less than half then. */
void test_a_pulse_that_lies_just_beyond_half_a_tick_is_the_one_before(void)
{
    const uint64_t slope = UINT64_C(1) << 40U;
    const uint32_t interval = 1000000;
    struct step_segment segment = {.slope = slope, .tick = 77, .steps = 1};

    segment.residual = STEP_QUANTA - interval * slope + slope / 2U + 1U;
    step_generator_aim(&segment, interval);
    TEST_ASSERT_EQUAL_UINT32(77 + interval - 1U, segment.tick);

    segment.tick = 77;
    segment.residual = STEP_QUANTA - interval * slope + slope / 2U;
    step_generator_aim(&segment, interval);
    TEST_ASSERT_EQUAL_UINT32(77 + interval, segment.tick);
}

/* A ramp that is a little more than half a tick's travel off a whole step after GUESS ticks: after it or before it. */
enum {
    GUESS = 5000
};

static struct step_generator ramp_off(int32_t accel, bool after)
{
    struct step_generator ramp = {.slope = slope_of(16000), .accel = accel, .tick = 77};
    uint64_t gain = wide_from_signed((int64_t)accel * GUESS);
    uint64_t off = (ramp.slope + 2U * gain) / 2U + 1000U;
    ramp.residual = STEP_QUANTA - GUESS * (ramp.slope + gain) + (after ? off : 0U - off);
    return ramp;
}

static void assert_found_after(struct step_generator ramp, uint32_t ticks)
{
    uint64_t accel = wide_from_signed(ramp.accel);
    struct step_generator found = ramp;

    TEST_ASSERT_EQUAL_UINT32(77 + ticks, step_generator_search(&found, GUESS));

    TEST_ASSERT_EQUAL_UINT32(ticks, found.interval);
    TEST_ASSERT_EQUAL_HEX64(ramp.slope + 2U * accel * ticks, found.slope);
    TEST_ASSERT_EQUAL_HEX64(ramp.residual + ticks * (ramp.slope + accel * ticks) - STEP_QUANTA, found.residual);
}

/* By the speed at the right tick, which is higher, the guess would be near enough. */
void test_a_pulse_of_a_ramp_that_lies_just_beyond_half_a_tick_is_a_tick_off_the_guess(void)
{
    const int32_t accel = 60000 * (int32_t)STEP_ACCEL_PER_ACCEL;

    assert_found_after(ramp_off(-accel, true), GUESS - 1);
    assert_found_after(ramp_off(accel, false), GUESS + 1);
}

/* The planner lays no such segment; the step interrupt would wait for it. */
void test_the_search_for_a_pulse_that_never_comes_ends(void)
{
    struct step_segment segment = {.tick = 77, .steps = 1};

    step_generator_aim(&segment, 1000);

    TEST_ASSERT_EQUAL_UINT64(0U - STEP_QUANTA, segment.residual);
}

/* What makes it fast: above some thousand steps/s the speed in the middle of an interval predicts its end. */
static unsigned predicted_of(const struct motion *motion, unsigned pulses)
{
    unsigned predicted = 0;
    begin(motion, TICK_HZ / motion->speed_steps_per_s);
    (void)next_pulse();
    for (unsigned k = 0; k < pulses; k++) {
        uint64_t middle = generator.slope + wide_from_signed((int64_t)generator.accel * (int32_t)generator.interval);
        uint32_t guess = step_generator_predict(generator.residual, middle);
        (void)next_pulse();
        predicted += generator.interval == guess ? 1U : 0U;
    }
    return predicted;
}

void test_nine_of_ten_intervals_of_a_fast_ramp_are_predicted(void)
{
    const struct motion up = {.speed_steps_per_s = 10000, .accel_steps_per_s2 = 2000};
    const struct motion down = {.speed_steps_per_s = 16000, .accel_steps_per_s2 = -30000};
    const struct motion fast = {.speed_steps_per_s = 100000, .accel_steps_per_s2 = 8000000};

    TEST_ASSERT_GREATER_OR_EQUAL_UINT(1800, predicted_of(&up, 2000));
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(1800, predicted_of(&down, 2000));
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(1800, predicted_of(&fast, 2000));
}

void test_intervals_of_a_constant_speed_are_the_whole_ticks_of_a_step_or_one_more(void)
{
    const struct motion motion = {.speed_steps_per_s = 15999};
    unsigned longer = 0;
    begin(&motion, TICK_HZ / 15999U);
    for (unsigned k = 0; k < 15999; k++) {
        (void)next_pulse();
        longer += generator.interval == TICK_HZ / 15999U + 1U ? 1U : 0U;
        TEST_ASSERT_TRUE(generator.interval - TICK_HZ / 15999U <= 1U);
    }
    TEST_ASSERT_EQUAL_UINT(TICK_HZ % 15999U, longer);
}

void test_a_copy_goes_on_like_the_original(void)
{
    const struct motion motion = {.speed_steps_per_s = 7, .accel_steps_per_s2 = 777};
    begin(&motion, TICK_HZ / 20U);
    for (unsigned k = 0; k < 100; k++) {
        (void)next_pulse();
    }
    struct step_generator copy = generator;

    for (unsigned k = 0; k < 100; k++) {
        TEST_ASSERT_EQUAL_UINT32(step_generator_next(&copy), next_pulse());
    }
}
