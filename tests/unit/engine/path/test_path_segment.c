#include "path_rig.h"
#include "path_segment.h"
#include "segment_view.h"
#include "unity.h"

static struct path_course course;
static struct path_speeds speeds;
static struct path_stretch stretch;
static unsigned leg;

static void lay(const struct path_vector *vector, uint64_t enter2, uint64_t exit2)
{
    struct path_section section;
    struct path_entry entry = {.time = {.high = 5000}, .speed2 = enter2};
    path_section_take(&section, vector);
    path_course_lay(&course, &section, &entry,
                    &(struct path_goal){.exit_speed2 = exit2, .speed = vector->speed, .rests = vector->speed == 0},
                    &speeds);
}

static struct step_segment segment(uint32_t steps, uint32_t pulse)
{
    stretch.steps = steps;
    stretch.pulse = pulse;
    stretch.last = path_course_last_pulse(&course, course.leg[leg].end, steps);
    struct path_pulse at = path_course_pulse(&course, &course.leg[leg], steps, pulse);
    return path_segment_lay(&course, &course.leg[leg], &stretch, &at);
}

void setUp(void)
{
    struct path_vector vector = rig_vector(1000, 333, 10000, 1000000);
    stretch = (struct path_stretch){0};
    leg = 0;
    lay(&vector, 0, 0);
}

void tearDown(void)
{
}

void test_a_pulse_is_on_the_nearest_tick(void)
{
    TEST_ASSERT_EQUAL_UINT64(7, path_segment_tick(&(struct path_pulse){.ticks = 7, .fraction = UINT32_C(0x7FFFFFFF)}));
    TEST_ASSERT_EQUAL_UINT64(8, path_segment_tick(&(struct path_pulse){.ticks = 7, .fraction = UINT32_C(0x80000000)}));
}

void test_the_longest_axis_has_the_motion_of_the_path(void)
{
    struct step_segment ramp = segment(1000, 1);
    TEST_ASSERT_EQUAL_INT32(128000000, ramp.accel);
    TEST_ASSERT_EQUAL_UINT32(50, ramp.steps);
    TEST_ASSERT_EQUAL_UINT32(5000 + 118794, ramp.tick);
    /* 0.061 tick after its time, at sqrt(2*A) steps/s. */
    TEST_ASSERT_UINT64_WITHIN(STEP_SLOPE_PER_SPEED, 1415 * STEP_SLOPE_PER_SPEED, ramp.slope);
    TEST_ASSERT_UINT64_WITHIN(ramp.slope / 500U, ramp.slope / 100U * 6U + ramp.slope / 800U, ramp.residual);
}

void test_the_other_axes_have_their_share_to_the_nearest(void)
{
    TEST_ASSERT_EQUAL_INT32(42624000, segment(333, 1).accel);
    course.length = 1001;
    course.per_length = path_divisor_of(1001);
    TEST_ASSERT_EQUAL_INT32(42581419, segment(333, 1).accel);
    leg = 2;
    TEST_ASSERT_EQUAL_INT32(-42581419, segment(333, 330).accel);
    TEST_ASSERT_EQUAL_INT32(-84907093, segment(664, 660).accel);
}

void test_a_cruise_is_one_segment_with_its_pace(void)
{
    leg = 1;
    struct step_segment cruise = segment(1000, 51);
    TEST_ASSERT_EQUAL_UINT32(8400, cruise.pace_ticks);
    TEST_ASSERT_EQUAL_UINT32(900, cruise.steps);
    TEST_ASSERT_EQUAL_UINT64(0, cruise.residual);
    TEST_ASSERT_EQUAL_UINT32(25225, segment(333, 17).pace_ticks);
}

/* At 9899.5 steps/s. */
void test_a_ramp_tells_its_first_pace_unless_it_has_one_pulse(void)
{
    TEST_ASSERT_EQUAL_UINT32(8485, segment(1000, 49).pace_ticks);
    TEST_ASSERT_EQUAL_UINT32(1, segment(1000, 50).steps);
    TEST_ASSERT_EQUAL_UINT32(0, segment(1000, 50).pace_ticks);
}

void test_a_brake_is_laid_anew_before_a_quarter_of_its_slope_is_left(void)
{
    leg = 2;
    struct step_segment brake = segment(1000, 951);
    TEST_ASSERT_TRUE(brake.steps > 40 && brake.steps < 50);
    struct step_segment last = segment(1000, 1000);
    TEST_ASSERT_EQUAL_UINT32(1, last.steps);
    TEST_ASSERT_EQUAL_UINT64(0, last.slope);
}

/* At a stand the slope would be negative half a tick later. */
void test_a_slope_is_never_negative(void)
{
    leg = 2;
    stretch = (struct path_stretch){.steps = 1000, .pulse = 1000, .last = 1000};
    struct path_pulse at = {.ticks = 100, .fraction = UINT32_C(0xC0000000), .slope256 = 0};
    struct step_segment last = path_segment_lay(&course, &course.leg[leg], &stretch, &at);
    TEST_ASSERT_EQUAL_UINT64(0, last.slope);
    TEST_ASSERT_EQUAL_UINT32(101, last.tick);
}

/* Half a quantum of acceleration is wrong at most: an eighth of a tick after sqrt(slope)/2 ticks. */
void test_a_share_that_is_a_fraction_is_laid_anew_in_time(void)
{
    struct path_vector vector = rig_vector(1000000, 777777, 200000, 1000);
    lay(&vector, 0, 0);
    struct step_segment fraction = segment(777777, 1000);
    struct step_generator end = seen_at(&fraction, fraction.tick + 10000000);
    (void)end;
    uint64_t ticks = 0;
    struct step_generator generator = {0};
    step_generator_load(&generator, &fraction);
    for (uint32_t i = 1; i < fraction.steps; i++) {
        ticks = step_generator_next(&generator) - fraction.tick;
    }
    TEST_ASSERT_TRUE(ticks * ticks < fraction.slope / 4U);
    TEST_ASSERT_TRUE(fraction.steps > 10);
    TEST_ASSERT_TRUE(segment(1000000, 1000).steps > 100 * fraction.steps);
}

void test_slow_pulses_are_alone(void)
{
    struct path_vector vector = rig_vector(1000, 1, 3, 8000000);
    lay(&vector, UINT64_C(768) * 768, UINT64_C(768) * 768);
    TEST_ASSERT_EQUAL_UINT32(1, segment(1000, 1).steps);
    TEST_ASSERT_EQUAL_UINT32(0, segment(1000, 1).pace_ticks);
}

/* At 1000 steps/s with 8 000 000 steps/s^2: v^2 < A/4. */
void test_a_first_pulse_too_slow_to_foretell_the_next_from_is_alone(void)
{
    struct path_vector vector = rig_vector(1000, 1, 100000, 8000000);
    lay(&vector, UINT64_C(256000) * 256000, 0);
    struct path_pulse at = {.ticks = 5000, .slope256 = 1000 * STEP_SLOPE_PER_SPEED * 256U};
    stretch = (struct path_stretch){.steps = 1000, .pulse = 1, .last = 100};
    TEST_ASSERT_EQUAL_UINT32(1, path_segment_lay(&course, &course.leg[0], &stretch, &at).steps);
    at.slope256 *= 2U;
    TEST_ASSERT_TRUE(path_segment_lay(&course, &course.leg[0], &stretch, &at).steps > 1);
}

/* ---- every field of random segments, by other means ------------------------------------------------------------- */

static uint64_t seed;

static uint64_t draw(unsigned bits)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (seed ^ seed >> 29U) >> (64U - bits);
}

/* Of any size up to so many bits, from 1 on. */
static uint64_t draw_size(unsigned bits)
{
    return draw(1U + (unsigned)(draw(32) % bits)) | 1U;
}

static uint64_t nearest(uint64_t value, uint64_t factor, uint64_t divisor)
{
    uint64_t rest = 0;
    uint64_t quotient = wide_divide(path_wide_multiply(value, factor), divisor, &rest);
    return quotient + (rest >= divisor - rest ? 1U : 0U);
}

static uint64_t root_of(uint64_t square)
{
    uint64_t root = 0;
    for (uint64_t bit = UINT64_C(1) << 31; bit != 0; bit >>= 1U) {
        root += (root + bit) * (root + bit) <= square ? bit : 0U;
    }
    return root + (square - root * root > root ? 1U : 0U);
}

/* For how long the rounding of slope and acceleration, half a quantum each, is an eighth of a tick's way at most, or
 * that of the slope that is left. */
static uint64_t longest_ticks(uint64_t slope, int32_t accel, bool exact)
{
    uint64_t least = accel < 0 ? slope / 16U : slope / 4U;
    uint64_t ticks = exact ? least / 16U : root_of(least) - 1U;
    ticks = ticks < UINT64_C(1) << 29 ? ticks : UINT64_C(1) << 29;
    uint64_t brake = accel < 0 ? 3U * slope / (8U * (uint64_t)-(int64_t)accel) : UINT64_MAX;
    return ticks < brake ? ticks : brake;
}

static uint32_t steps_of(uint64_t slope, int32_t accel, bool exact, uint32_t left)
{
    uint64_t rest = 0;
    if (left == 0 || slope < STEP_QUANTA >> 24U) {
        return 1;
    }
    if (accel > 0 && (uint64_t)accel > 2U * slope / (STEP_QUANTA / slope + 1U)) {
        return 1;
    }
    uint64_t ticks = longest_ticks(slope, accel, exact);
    uint64_t mean = slope + wide_from_signed((int64_t)accel * (int64_t)ticks);
    uint64_t steps = wide_divide(path_wide_multiply(mean, ticks), STEP_QUANTA, &rest);
    return 1U + (uint32_t)(steps < left ? steps : left);
}

/* Returns its steps. */
static uint32_t assert_segment_until(uint32_t last, uint32_t steps, const struct path_pulse *at)
{
    uint32_t length = course.length;
    int32_t leg_accel = course.leg[0].accel;
    stretch = (struct path_stretch){.steps = steps, .pulse = 1, .last = last};
    struct step_segment made = path_segment_lay(&course, &course.leg[0], &stretch, at);

    uint64_t size = (uint64_t)(leg_accel < 0 ? -(int64_t)leg_accel : leg_accel);
    int32_t accel = (int32_t)nearest(size, steps, length) * (leg_accel < 0 ? -1 : 1);
    TEST_ASSERT_EQUAL_INT32(accel, made.accel);

    bool up = at->fraction >= UINT32_C(1) << 31;
    TEST_ASSERT_EQUAL_UINT32((uint32_t)at->ticks + (up ? 1U : 0U), made.tick);
    int64_t late = up ? (INT64_C(1) << 32) - (int64_t)at->fraction : -(int64_t)at->fraction;
    int64_t slope256 = (int64_t)at->slope256 + (int64_t)leg_accel * late / (INT64_C(1) << 23);
    uint64_t slope = nearest(slope256 > 0 ? (uint64_t)slope256 : 0U, steps, (uint64_t)length * 256U);
    TEST_ASSERT_EQUAL_UINT64(slope, made.slope);

    uint64_t mean = slope - wide_from_signed((int64_t)accel * late / (INT64_C(1) << 32));
    uint64_t way = wide_scale(mean, (uint32_t)(late < 0 ? -late : late));
    TEST_ASSERT_EQUAL_UINT64(late < 0 ? 0U - way : way, made.residual);

    uint64_t rest = 0;
    (void)wide_divide(path_wide_multiply(size, steps), length, &rest);
    TEST_ASSERT_EQUAL_UINT32(steps_of(slope, accel, rest == 0, stretch.last - 1U), made.steps);
    bool paced = slope >= STEP_QUANTA >> 24U && (accel == 0 || made.steps > 1);
    TEST_ASSERT_EQUAL_UINT32(paced ? STEP_QUANTA / slope : 0U, made.pace_ticks);
    return made.steps;
}

/* On a stretch of any length, and on one that is a step longer than what is near enough. */
static void assert_segment(uint32_t length, uint32_t steps, int32_t leg_accel, const struct path_pulse *at)
{
    course.length = length;
    course.per_length = path_divisor_of(length);
    course.leg[0].accel = leg_accel;
    uint32_t near = assert_segment_until(INT32_MAX, steps, at);
    (void)assert_segment_until(near + 1U, steps, at);
    (void)assert_segment_until((uint32_t)draw_size(31), steps, at);
}

void test_each_field_of_a_segment_is_rounded_to_the_nearest(void)
{
    seed = 1;
    for (unsigned i = 0; i < 100000; i++) {
        uint32_t length = (uint32_t)(draw_size(31) - draw(1)) | 2U;
        uint32_t steps = draw(2) == 0 ? length : (uint32_t)(1U + draw(32) % length);
        steps = draw(3) == 0 && length > 8 ? length / (uint32_t)(2U + draw(2)) : steps;
        int32_t accel = draw(4) == 0 ? 0 : (int32_t)(draw_size(30) % (PATH_ACCEL_MAX + 1U));
        accel = draw(1) == 0 ? accel : -accel;
        struct path_pulse at = {
            .ticks = draw(40),
            .fraction = draw(3) == 0 ? (uint32_t)draw(1) << 31U : (uint32_t)draw(32),
            .slope256 = draw_size(60) + (draw(1) << 43U),
        };
        assert_segment(length, steps, accel, &at);
    }
}

/* Where the acceleration is just so much that a first pulse is of use, and one more or less. */
void test_a_first_pulse_is_of_use_up_to_one_acceleration(void)
{
    seed = 2;
    for (unsigned i = 0; i < 10000; i++) {
        uint64_t slope = UINT64_C(1) << 38U | draw(38U + i % 8U);
        uint64_t accel = 2U * slope / (STEP_QUANTA / slope + 1U) + i % 3U;
        if (accel > 1U && accel <= PATH_ACCEL_MAX) {
            assert_segment(7, 7, (int32_t)accel - 1, &(struct path_pulse){.ticks = i, .slope256 = slope << 8U});
        }
    }
}

void test_a_slope_is_slow_below_its_limit_only(void)
{
    struct path_pulse at = {.ticks = 1000, .slope256 = (STEP_QUANTA >> 24U) << 8U};
    assert_segment(5, 5, 0, &at);
    at.slope256 -= 256U;
    assert_segment(5, 5, 0, &at);
}
