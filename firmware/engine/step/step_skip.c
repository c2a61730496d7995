#include "step_skip.h"

#include <assert.h>

#include "base_tick.h"

enum {
    INTERVAL_TICKS_MAX = 40 * TICKS_PER_US,
    CHANGE_SHIFT = 3,
};

/* Positions are known modulo 2^64, which is ten steps: where the speed changes by an eighth at most, no other pulse
 * looks like the one that is wanted. */
static_assert(UINT64_C(1) * STEP_SKIP_MAX * INTERVAL_TICKS_MAX * (UINT64_C(1) << 31U) <
                  STEP_QUANTA / INTERVAL_TICKS_MAX >> (unsigned)CHANGE_SHIFT,
              "no acceleration may change the speed of pulses that come so fast by more than that");
static_assert(STEP_SKIP_MAX * (STEP_QUANTA >> 32U) < (UINT64_C(1) << 32U) - (UINT64_C(1) << 28U),
              "the way that is skipped must fit 32 bits, with half a tick's travel");

/* The time for the way of some pulses at a speed, from the high words of both. */
static uint32_t skip_ticks(uint32_t pulses, uint64_t residual, uint64_t slope)
{
    uint32_t way = pulses * (uint32_t)(STEP_QUANTA >> 32U) - (uint32_t)(residual >> 32U);
    uint32_t speed = (uint32_t)(slope >> 32U) | 1U;
    return (way + speed / 2U) / speed;
}

/* Whether a position is within half a tick's travel of a whole step, and no other tick's is: at the edges two would do.
 */
static bool is_clear(uint64_t residual, uint64_t slope)
{
    return residual + (slope >> 1U) - 2U <= slope - 4U;
}

/* By the speed in the middle of the way. */
bool step_skip(struct step_generator *generator, uint32_t pulses)
{
    uint64_t slope = generator->slope;
    int64_t accel = generator->accel;
    uint32_t about = skip_ticks(pulses, generator->residual, slope);
    if (about > pulses * (uint32_t)INTERVAL_TICKS_MAX) {
        return false;
    }
    uint32_t ticks = skip_ticks(pulses, generator->residual, slope + wide_from_signed(accel * (int64_t)about));
    uint64_t gain = wide_from_signed(accel * (int64_t)ticks);
    uint64_t residual = generator->residual + ticks * (slope + gain) - pulses * STEP_QUANTA;
    bool clear = is_clear(residual, slope + 2U * gain);
    if (clear) {
        (void)step_generator_accept(generator, residual, slope + 2U * gain, ticks);
        generator->interval = ticks / pulses;
    }
    return clear;
}
