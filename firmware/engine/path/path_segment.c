#include "path_segment.h"

#include "path_divide.h"
#include "path_root.h"
#include "path_wide.h"
#include "step_generator.h"
#include "step_scale.h"

/* A segment lasts at most so long: its pulses are told by the low half of their ticks. */
static const uint64_t SEGMENT_TICKS_MAX = UINT64_C(1) << 29;

/* An axis below 3.2 steps/s gets each pulse by itself: no interval of a segment is longer than 2^26 ticks. */
static const uint64_t SLOPE_LEAST = STEP_QUANTA >> 24U;

/* From this slope on no acceleration is too much for the generator to foretell the next pulse: 2^30 * 2^16. */
static const uint64_t ALWAYS_OF_USE = UINT64_C(1) << 45;
static_assert(((STEP_QUANTA >> 45U) + 1U) * PATH_ACCEL_MAX <= UINT64_C(1) << 46, "a fast first pulse must be of use");

uint64_t path_segment_tick(const struct path_pulse *pulse)
{
    return pulse->ticks + (pulse->fraction >> 31U);
}

/* The share of an axis in the acceleration, with sign, and whether it is exact. */
struct share {
    int32_t accel;
    bool exact;
};

static struct share share_of(const struct path_course *course, const struct path_leg *leg, uint32_t steps)
{
    if (steps == course->length || leg->accel == 0) {
        return (struct share){.accel = leg->accel, .exact = true};
    }
    uint64_t rest = 0;
    uint64_t size = (uint64_t)(leg->accel < 0 ? -leg->accel : leg->accel);
    uint64_t accel = path_divide((struct wide){.low = size * steps}, &course->per_length, &rest);
    accel += rest >= course->length - rest ? 1U : 0U;
    return (struct share){.accel = leg->accel < 0 ? -(int32_t)accel : (int32_t)accel, .exact = rest == 0};
}

/* The slope of the axis at the whole tick, `late` / 2^32 tick after the pulse; not below 0. */
static uint64_t slope_at(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                         const struct path_pulse *at, int64_t late)
{
    int64_t gain = 2 * (int64_t)leg->accel * late / (INT64_C(1) << 24);
    int64_t sum = (int64_t)at->slope256 + gain;
    uint64_t slope256 = sum > 0 ? (uint64_t)sum : 0U;
    if (steps == course->length) {
        return ((slope256 >> 7U) + 1U) >> 1U;
    }
    uint64_t rest = 0;
    struct path_divisor divisor = course->per_length;
    divisor.shift -= 8U;
    uint64_t slope = path_divide(path_wide_multiply(slope256, steps), &divisor, &rest);
    return slope + (rest >= ((uint64_t)course->length << 7U) ? 1U : 0U);
}

/* The way of the axis in `late` / 2^32 tick, with the slope at the end of that time. */
static uint64_t residual_at(uint64_t slope, int32_t accel, int64_t late)
{
    uint64_t mean = slope - wide_from_signed(accel * late / (INT64_C(1) << 32));
    return late < 0 ? 0U - wide_scale(mean, (uint32_t)-late) : wide_scale(mean, (uint32_t)late);
}

static uint64_t lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* For how long a segment is near enough to the path. A brake ends while a quarter of the slope is left: that slope
 * counts, and the generator needs it. */
static uint64_t ticks_of(uint64_t slope, struct share share)
{
    bool brakes = share.accel < 0;
    uint64_t least = brakes ? slope / 16U : slope / 4U;
    uint64_t ticks = share.exact ? least / 16U : path_root((struct wide){.low = least}) - 1U;
    uint64_t size = (uint64_t)(brakes ? -(int64_t)share.accel : share.accel);
    ticks = lower(ticks, SEGMENT_TICKS_MAX);
    return brakes ? lower(ticks, 3U * slope / (8U * size)) : ticks;
}

/* The way of so many ticks. */
static struct wide way_in(uint64_t ticks, uint64_t slope, int32_t accel)
{
    return path_wide_multiply(slope + wide_from_signed(accel * (int64_t)ticks), ticks);
}

/* Less than ticks_of by a factor of 16 at most, and found without a root and a division: powers of two below both of
 * what it is the lower of. */
static uint64_t few_ticks_of(uint64_t slope, struct share share)
{
    unsigned bits = path_wide_bits(slope);
    unsigned root = (bits - 5U) / 2U;
    if (share.accel >= 0) {
        return (UINT64_C(1) << root) - 1U;
    }
    unsigned brake = bits - 3U - wide_bits((uint32_t)-share.accel);
    return (UINT64_C(1) << (brake < root ? brake : root)) - 1U;
}

/* Whether a segment is near enough to the path for so many steps: the time that is sure will mostly do. */
static bool are_near(uint32_t steps, uint64_t slope, struct share share)
{
    struct wide way = way_in(few_ticks_of(slope, share), slope, share.accel);
    return path_wide_is_at_least(way, path_wide_multiply(STEP_QUANTA, steps));
}

/* Whether what the generator foretells from a first pulse is of any use: from a stand between steps the first pulse may
 * come so soon and so slow that it is not. accel * Q > 2 * slope^2 says that A/4 > v^2. */
static bool is_useless(uint64_t slope, int32_t accel)
{
    return accel > 0 && slope < ALWAYS_OF_USE && (uint64_t)accel > 2U * slope / (STEP_QUANTA / slope + 1U);
}

static uint32_t pulses_of(const struct path_stretch *stretch, uint64_t slope, struct share share)
{
    uint32_t left = stretch->last - stretch->pulse;
    if (left == 0 || slope < SLOPE_LEAST || is_useless(slope, share.accel)) {
        return 1;
    }
    if (are_near(left, slope, share)) {
        return 1U + left;
    }
    uint64_t rest = 0;
    uint64_t steps = wide_divide(way_in(ticks_of(slope, share), slope, share.accel), STEP_QUANTA, &rest);
    return 1U + (uint32_t)lower(left, steps);
}

/* Whole ticks of a step. Where the slope is large, the upper words decide, but for one tick or two. */
static uint32_t pace_of(uint64_t slope)
{
    if (slope < ALWAYS_OF_USE) {
        return (uint32_t)(STEP_QUANTA / slope);
    }
    uint32_t pace = (uint32_t)(STEP_QUANTA >> 30U) / ((uint32_t)(slope >> 30U) + 1U);
    uint64_t rest = STEP_QUANTA - pace * slope;
    while (rest >= slope) {
        rest -= slope;
        pace++;
    }
    return pace;
}

struct step_segment path_segment_lay(const struct path_course *course, const struct path_leg *leg,
                                     const struct path_stretch *stretch, const struct path_pulse *at)
{
    uint64_t tick = path_segment_tick(at);
    int64_t late = (tick > at->ticks ? INT64_C(1) << 32 : 0) - (int64_t)at->fraction;
    struct share share = share_of(course, leg, stretch->steps);
    uint64_t slope = slope_at(course, leg, stretch->steps, at, late);
    uint32_t pulses = pulses_of(stretch, slope, share);
    bool paced = slope >= SLOPE_LEAST && (share.accel == 0 || pulses > 1U);
    return (struct step_segment){
        .residual = residual_at(slope, share.accel, late),
        .slope = slope,
        .accel = share.accel,
        .tick = (uint32_t)tick,
        .pace_ticks = paced ? pace_of(slope) : 0U,
        .steps = pulses,
    };
}
