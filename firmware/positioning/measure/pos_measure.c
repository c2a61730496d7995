#include "pos_measure.h"

#include <stdbool.h>

#include "base_wide.h"

enum {
    FEED_FACTOR = 25, /* 256 / (60 * 65 536) step/s, times 1000 um/mm: 25 / 384 */
    FEED_DIVISOR = 384,
    ACCEL_FACTOR = 128000, /* 128 * 1000 um/mm */
};

/* At most `highest`, and 1 at least where it was not 0. */
static uint32_t bounded(uint64_t value, uint32_t asked, uint32_t highest)
{
    if (asked == 0U) {
        return 0;
    }
    uint64_t bound = value < highest ? value : highest;
    return bound == 0U ? 1U : (uint32_t)bound;
}

uint32_t pos_measure_speed(const struct pos_scale *scale, uint32_t feed, uint32_t highest)
{
    struct wide product = wide_multiply((uint64_t)feed * (uint64_t)FEED_FACTOR, scale->steps);
    uint64_t divisor = (uint64_t)FEED_DIVISOR * scale->micrometres;
    return bounded(wide_divide_nearest(product, divisor), feed, highest);
}

uint32_t pos_measure_accel(const struct pos_scale *scale, uint32_t accel_mm_s2, uint32_t highest)
{
    struct wide product = wide_multiply((uint64_t)accel_mm_s2 * (uint64_t)ACCEL_FACTOR, scale->steps);
    return bounded(wide_divide_nearest(product, scale->micrometres), accel_mm_s2, highest);
}

uint32_t pos_measure_feed(const struct pos_scale *scale, uint32_t speed)
{
    struct wide product = wide_multiply((uint64_t)speed * (uint64_t)FEED_DIVISOR, scale->micrometres);
    uint64_t feed = wide_divide_nearest(product, (uint64_t)FEED_FACTOR * scale->steps);
    return feed < UINT32_MAX ? (uint32_t)feed : UINT32_MAX;
}

static int64_t floor_of(int64_t dividend, int64_t divisor)
{
    int64_t quotient = dividend / divisor;
    return dividend % divisor < 0 ? quotient - 1 : quotient;
}

/* (value * factor + addend) / divisor, rounded down. The quotient must fit. */
static int64_t divide_down(int64_t value, uint64_t factor, uint64_t addend, uint64_t divisor)
{
    uint64_t rest = 0;
    bool negative = value < 0;
    struct wide product = wide_multiply(negative ? 0U - (uint64_t)value : (uint64_t)value, factor);
    int64_t quotient = (int64_t)wide_divide(product, divisor, &rest);
    int64_t left = (int64_t)addend + (negative ? -(int64_t)rest : (int64_t)rest);
    return (negative ? -quotient : quotient) + floor_of(left, (int64_t)divisor);
}

int64_t pos_measure_step(const struct pos_scale *scale, int64_t way_um)
{
    uint64_t divisor = UINT64_C(2) * scale->micrometres;
    return divide_down(way_um, UINT64_C(2) * scale->steps, scale->micrometres, divisor);
}

int64_t pos_measure_um(const struct pos_scale *scale, int64_t step)
{
    return divide_down(step, UINT64_C(2) * scale->micrometres, scale->steps, UINT64_C(2) * scale->steps);
}

/* The way of a step is rounded: it is `way_um` from (way_um - 1/2) * steps / micrometres on, and more from one
 * micrometre later on. */
int64_t pos_measure_last_step(const struct pos_scale *scale, int64_t way_um)
{
    return pos_measure_first_step(scale, way_um + 1) - 1;
}

int64_t pos_measure_first_step(const struct pos_scale *scale, int64_t way_um)
{
    uint64_t divisor = UINT64_C(2) * scale->micrometres;
    return -divide_down(-way_um, UINT64_C(2) * scale->steps, scale->steps, divisor);
}
