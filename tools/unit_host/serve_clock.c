#include "serve_clock.h"

#include <assert.h>

#include "base_tick.h"
#include "units.h"

enum {
    MILLI = 1000
};

/* Ticks that serve_clock_ns looks ahead: 16 hours at speed 1, a minute at the highest. */
#define AHEAD_TICKS_MAX UINT64_C(5000000000000)

static_assert(TICK_HZ % MILLI == 0, "whole seconds must be whole ticks at every speed");
static_assert(AHEAD_TICKS_MAX <= UINT64_MAX / 250U / MILLI, "the way to nanoseconds must not overflow");

void serve_clock_set(struct serve_clock *clock, uint64_t real_ns, uint64_t tick)
{
    clock->base_ns = real_ns;
    clock->base_tick = tick;
}

uint64_t serve_clock_tick(struct serve_clock *clock, uint64_t real_ns)
{
    uint64_t seconds = (real_ns - clock->base_ns) / NS_PER_SECOND;
    clock->base_ns += seconds * NS_PER_SECOND;
    clock->base_tick += seconds * (TICK_HZ / MILLI) * clock->milli_speed;
    return clock->base_tick + units_ticks_of_ns((real_ns - clock->base_ns) * clock->milli_speed) / MILLI;
}

uint64_t serve_clock_ns(const struct serve_clock *clock, uint64_t tick)
{
    uint64_t ticks = tick < clock->base_tick ? 0 : tick - clock->base_tick + 1U;
    ticks = ticks < AHEAD_TICKS_MAX ? ticks : AHEAD_TICKS_MAX;
    return clock->base_ns + units_ns_of_ticks(ticks) * MILLI / clock->milli_speed + 1U;
}
