#include "step_generator.h"

#include <assert.h>
#include <stdbool.h>

#include "base_wide.h"
#include "step_scale.h"

enum {
    FINE_BITS = 5, /* of `period`, `change` and `lag` */
    FINE_HALF = 1 << (FINE_BITS - 1),

    /* Newton's rule doubles the exact digits, except near a stand, where it halves the error; 32 bits of interval
     * and the bits of a division end it long before. */
    CORRECTIONS_MAX = 48,
};

/* 2^69 / STEP_QUANTA, see lag_of. */
#define LAG_SCALE ((int32_t)((UINT64_C(1) << 63) / (STEP_QUANTA >> 6U)))

static_assert(STEP_INTERVAL_TICKS_MAX <= UINT32_MAX >> FINE_BITS, "the longest interval must fit with its fraction");
static_assert((UINT64_C(1) << 63) / (STEP_QUANTA >> 6U) <= UINT64_C(1) << 16, "LAG_SCALE must leave room in 64 bits");

/* Where the search stands: position and slope after `interval` ticks. */
struct search {
    uint64_t residual;
    uint64_t slope;
    uint32_t interval;
};

void step_generator_start(struct step_generator *generator, uint32_t tick)
{
    *generator = (struct step_generator){.tick = tick};
}

void step_generator_load(struct step_generator *generator, const struct step_segment *segment)
{
    uint64_t accel = wide_from_signed(segment->accel);
    uint64_t shift = wide_from_signed(tick_difference(generator->tick, segment->tick));
    uint32_t interval = segment->tick + segment->interval_ticks - generator->tick;

    generator->accel = segment->accel;
    generator->residual = segment->residual + shift * (segment->slope + accel * shift);
    generator->slope = segment->slope + 2U * accel * shift;
    generator->period = (interval << FINE_BITS) + (uint32_t)generator->lag;
    generator->change = 0;
}

/* Whether the position is within half a tick's way of the whole step. */
static inline bool search_is_done(const struct search *search)
{
    return search->residual + (search->slope >> 1U) <= search->slope;
}

static inline void search_shorten(struct search *search, int64_t ticks, int32_t accel)
{
    int64_t gain = accel * ticks;
    search->residual -= wide_from_signed(ticks) * (search->slope - wide_from_signed(gain));
    search->slope -= 2U * wide_from_signed(gain);
    search->interval -= (uint32_t)wide_from_signed(ticks);
}

/* distance / slope rounded to the nearest, at least 1; about 16 good bits. Both are shifted until they fit 31 bits. */
static uint32_t search_quotient(uint64_t distance, uint64_t slope)
{
    unsigned shift = wide_bits((uint32_t)((distance | slope) >> 31U));
    uint32_t divisor = (uint32_t)(slope >> shift) | 1U;
    uint32_t quotient = ((uint32_t)(distance >> shift) + divisor / 2U) / divisor;
    return quotient != 0 ? quotient : 1U;
}

static void search_correct(struct search *search, int32_t accel)
{
    for (unsigned i = 0; i < CORRECTIONS_MAX && !search_is_done(search); i++) {
        bool late = wide_to_signed(search->residual) > 0;
        uint64_t distance = late ? search->residual : 0U - search->residual;
        int64_t ticks = distance <= search->slope ? 1 : search_quotient(distance, search->slope);
        search_shorten(search, late ? ticks : -ticks, accel);
    }
}

/* residual / slope in 1/32 ticks. As slope * interval is nearly STEP_QUANTA, that is residual * interval * 32 /
 * STEP_QUANTA; the high word of the residual will do, and its product with the interval fits 32 bits. */
static inline int32_t lag_of(const struct search *search)
{
    uint32_t high = (uint32_t)(search->residual >> 32U);
    return wide_multiply_high(wide_to_signed_32(high * search->interval), LAG_SCALE);
}

/* How the period will change. As it goes with 1/speed, each change is the last one times 1 + 3 * change / period, and
 * 1/period is nearly slope / (32 * STEP_QUANTA): so it is change + change^2 * slope * 3 / 2^65.65, where 3 / 2^65.65 is
 * 1 / 2^64 but for 5 %. From a stand the periods shrink faster than any such rule: never by more than a quarter. */
static inline uint32_t change_of(uint32_t period, uint32_t last, uint64_t slope)
{
    uint32_t change = period - last;
    if (wide_to_signed_32(change + period / 4U) < 0 && period < last) {
        return 0U - period / 4U;
    }
    uint32_t growth = change * (uint32_t)(slope >> 33U);
    return change + 2U * (uint32_t)wide_multiply_high(wide_to_signed_32(change), wide_to_signed_32(growth));
}

uint32_t step_generator_next(struct step_generator *generator)
{
    uint32_t foretold = generator->period + generator->change - (uint32_t)generator->lag;
    struct search search = {.interval = (foretold + FINE_HALF) >> FINE_BITS};
    uint64_t gain = wide_from_signed((int64_t)generator->accel * (int32_t)search.interval);
    uint64_t middle = generator->slope + gain;
    search.residual = generator->residual + search.interval * middle - STEP_QUANTA;
    search.slope = middle + gain;
    if (!search_is_done(&search)) {
        search_correct(&search, generator->accel);
    }

    int32_t lag = lag_of(&search);
    uint32_t period = (search.interval << FINE_BITS) + (uint32_t)generator->lag - (uint32_t)lag;
    if (generator->accel != 0) {
        generator->change = change_of(period, generator->period, search.slope);
    }
    generator->residual = search.residual;
    generator->slope = search.slope;
    generator->interval = search.interval;
    generator->period = period;
    generator->lag = lag;
    generator->tick += search.interval;
    return generator->tick;
}
