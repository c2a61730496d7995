/* clock_gettime: a clock that nobody sets. */
#define _POSIX_C_SOURCE 200809L

#include "units.h"

#include <assert.h>
#include <time.h>

#include "base_tick.h"

/* TICK_HZ / 1e9 in lowest terms. */
enum {
    RATIO_TICKS = 21,
    RATIO_NS = 250,
};

static_assert(NS_PER_SECOND / RATIO_NS * RATIO_TICKS == TICK_HZ, "the ratio must be the timer's");

/* value * numerator / denominator, rounded to the nearest, without overflow on the way. */
static uint64_t scale(uint64_t value, uint64_t numerator, uint64_t denominator)
{
    uint64_t rest = value % denominator * numerator;
    return value / denominator * numerator + (rest + denominator / 2U) / denominator;
}

uint64_t units_ticks_of_ns(uint64_t ns)
{
    return scale(ns, RATIO_TICKS, RATIO_NS);
}

uint64_t units_ns_of_ticks(uint64_t ticks)
{
    return scale(ticks, RATIO_NS, RATIO_TICKS);
}

uint64_t units_milli_speed(uint64_t interval_ticks)
{
    return interval_ticks == 0 ? 0 : (TICK_HZ * UINT64_C(1000) + interval_ticks / 2U) / interval_ticks;
}

uint64_t units_real_ns(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * NS_PER_SECOND + (uint64_t)now.tv_nsec;
}
