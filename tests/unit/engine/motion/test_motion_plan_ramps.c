#include "base_wide.h"
#include "epoch.h"
#include "motion_point.h"
#include "plan_walk.h"
#include "step_scale.h"
#include "unity.h"

/* What tests/proofs leaves open: that the first pulse of a ramp is on its ramp (is_on_ramp of search_pulses.h); from it
 * follow the next ones. Here it is seen of all pulses of random moves with stops and changes of speed. */
enum {
    MOVES = 20000,
    SECTIONS_MAX = 4,
    STEPS_MAX = 5000
};

/* The slope of 0.98 steps/s. */
#define LEAST_SLOPE UINT64_C(21000000000)
#define MOST_SLOPE (UINT64_C(1) << 54)

static uint64_t ramp_pulses;

void setUp(void)
{
}

void tearDown(void)
{
}

/* 1 to most, small numbers as often as large ones. */
static uint32_t some(uint32_t most)
{
    uint64_t chance = epoch_chance();
    return (uint32_t)((chance >> 32U) % (most >> chance % wide_bits(most))) + 1U;
}

/* Whether a ramp from or to that speed has fewer than 2^32 steps, as motion_order.h asks. */
static bool is_short(uint32_t speed, uint32_t accel)
{
    return (uint64_t)speed * speed < ((uint64_t)accel << 33U);
}

static struct motion_section some_section(uint32_t start_speed)
{
    struct motion_section section;
    do {
        section = (struct motion_section){
            .steps = some(STEPS_MAX),
            .speed_steps_per_s = some(MOTION_SPEED_MAX),
            .accel_steps_per_s2 = some(STEP_ACCEL_MAX),
        };
    } while (!is_short(section.speed_steps_per_s, section.accel_steps_per_s2) ||
             !is_short(start_speed, section.accel_steps_per_s2));
    return section;
}

static void begin(void)
{
    struct motion_order order = {.start_speed_steps_per_s = some(50000), .sections = (uint8_t)some(SECTIONS_MAX)};
    for (unsigned i = 0; i < order.sections; i++) {
        order.section[i] = some_section(order.start_speed_steps_per_s);
    }
    walk_begin(&order, epoch_random());
}

static struct wide plus(struct wide value, uint64_t a, uint64_t b)
{
    return wide_add(value, wide_multiply(a, b));
}

static struct wide minus(struct wide value, uint64_t a, uint64_t b)
{
    return wide_subtract(value, wide_multiply(a, b));
}

/* slope^2 - 4*accel*residual: the square of the slope at the whole step that the pulse stands for. */
static struct wide curve(const struct step_generator *generator, uint64_t accel)
{
    struct wide square = wide_multiply(generator->slope, generator->slope);
    int64_t residual = wide_to_signed(generator->residual);
    bool less = (residual < 0) == (generator->accel < 0);
    uint64_t size = residual < 0 ? (uint64_t)-residual : (uint64_t)residual;
    return less ? minus(square, 4U * accel, size) : plus(square, 4U * accel, size);
}

static void assert_in_range(struct wide least, struct wide most)
{
    TEST_ASSERT_TRUE_MESSAGE(wide_is_at_least(least, wide_multiply(LEAST_SLOPE, LEAST_SLOPE)), "too slow");
    TEST_ASSERT_TRUE_MESSAGE(wide_is_at_least(wide_multiply(MOST_SLOPE, MOST_SLOPE), most), "too fast");
}

static void assert_speeding(const struct step_generator *generator, uint64_t accel)
{
    struct wide square = curve(generator, accel);
    struct wide room = wide_multiply(LEAST_SLOPE, LEAST_SLOPE);
    TEST_ASSERT_TRUE_MESSAGE(wide_is_at_least(square, plus(room, 4U * accel, STEP_QUANTA)), "too slow");
    assert_in_range(square, plus(square, 4U * accel * cursor.left, STEP_QUANTA));
}

/* The next interval is predicted from the one before: that was at most 5/4 of a step's, or no longer than the next, but
 * for two ticks. */
static bool is_predicted_well(const struct step_generator *generator, uint64_t accel)
{
    uint64_t ticks = generator->interval;
    struct wide distance = wide_multiply(4U * ticks, generator->slope);
    bool like_next = wide_is_at_least(wide_multiply(5, STEP_QUANTA), distance) &&
                     4U * accel * ticks <= generator->slope + 10U * accel;
    struct wide missing = {.low = STEP_QUANTA - generator->residual};
    distance = wide_multiply(ticks - 2U, generator->slope - accel * (ticks - 2U));
    return like_next || (2U * accel * ticks <= generator->slope && wide_is_at_least(missing, distance));
}

static void assert_braking(const struct step_generator *generator, uint64_t accel)
{
    struct wide square = curve(generator, accel);
    struct wide distance = wide_multiply(4U * accel * cursor.left, STEP_QUANTA);
    TEST_ASSERT_TRUE_MESSAGE(wide_is_at_least(square, distance), "too slow");
    assert_in_range(wide_subtract(square, distance), square);
    TEST_ASSERT_TRUE_MESSAGE(cursor.left == 0 || is_predicted_well(generator, accel), "a bad interval before");
}

static void assert_on_ramp(const struct step_generator *generator)
{
    TEST_ASSERT_TRUE_MESSAGE(step_generator_is_near(generator->residual, generator->slope), "not near a whole step");
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(STEP_INTERVAL_TICKS_MAX, generator->interval);
    ramp_pulses += generator->accel != 0;
    if (generator->accel > 0) {
        assert_speeding(generator, (uint64_t)generator->accel);
    } else if (generator->accel < 0) {
        assert_braking(generator, (uint64_t)-(int64_t)generator->accel);
    }
}

/* Lays the rest anew from the pulse that was made; no change above what a ramp of the section reaches. */
static void lay_anew(void)
{
    struct motion_point at = motion_point_of(&cursor, now);
    uint32_t speed = some(MOTION_SPEED_MAX);
    bool fits = true;
    for (unsigned i = 0; i < plan.order.sections; i++) {
        fits = fits && is_short(speed, plan.order.section[i].accel_steps_per_s2);
    }
    bool replanned =
        epoch_chance() % 2U == 0 || !fits ? motion_plan_stop(&plan, &at) : motion_plan_change_speed(&plan, &at, speed);
    if (replanned) {
        cursor.end -= cursor.left;
        cursor.left = 0;
    }
}

static void move(void)
{
    begin();
    uint32_t anew = some(SECTIONS_MAX * STEPS_MAX);
    for (uint32_t made = 1; walk_on(); made++) {
        assert_on_ramp(&cursor.generator);
        if (made == anew) {
            lay_anew();
            anew += some(STEPS_MAX);
        }
    }
    TEST_ASSERT_EQUAL_UINT32(0, cursor.left);
}

void test_every_pulse_of_a_ramp_is_on_it(void)
{
    ramp_pulses = 0;
    for (unsigned i = 0; i < MOVES; i++) {
        move();
    }
    TEST_ASSERT_GREATER_THAN_UINT64(1000000, ramp_pulses);
}
