#include "step_generator.h"

#include "base_tick.h"

enum {
    /* Newton's rule doubles the exact digits, except near a stand, where it halves the error; 32
     * bits of interval and the bits of a division end it long before. */
    CORRECTIONS_MAX = 48,
};

void step_generator_start(struct step_generator *generator, uint32_t tick)
{
    *generator = (struct step_generator){.tick = tick};
}

void step_generator_join(struct step_generator *generator, const struct step_segment *segment, uint32_t made)
{
    uint64_t accel = wide_from_signed(segment->accel);
    uint64_t shift = wide_from_signed(tick_difference(generator->tick, segment->tick));
    step_generator_take_motion(generator, segment);
    generator->residual =
        segment->residual + shift * (segment->slope + accel * shift) + STEP_QUANTA - made * STEP_QUANTA;
    generator->slope = segment->slope + 2U * accel * shift;
}

/* Where the search for a pulse stands: position and slope after `interval` ticks. */
struct search {
    uint64_t residual;
    uint64_t slope;
    uint32_t interval;
};

static inline void search_lengthen(struct search *search, uint32_t ticks, int32_t accel)
{
    uint64_t gain = wide_from_signed((int64_t)accel * (int32_t)ticks);
    search->residual += ticks * (search->slope + gain);
    search->slope += 2U * gain;
    search->interval += ticks;
}

static inline void search_shorten(struct search *search, uint32_t ticks, int32_t accel)
{
    uint64_t gain = wide_from_signed((int64_t)accel * (int32_t)ticks);
    search->residual -= ticks * (search->slope - gain);
    search->slope -= 2U * gain;
    search->interval -= ticks;
}

/* distance / slope rounded to the nearest, at least 1. Both are shifted until they fit 31 bits,
 * which leaves it an eighth off at most. */
static inline uint32_t search_quotient(uint64_t distance, uint64_t slope)
{
    unsigned shift = wide_bits((uint32_t)((distance | slope) >> 31U));
    uint32_t divisor = (uint32_t)(slope >> shift) | 1U;
    uint32_t quotient = ((uint32_t)(distance >> shift) + divisor / 2U) / divisor;
    return quotient != 0 ? quotient : 1U;
}

static inline void search_correct(struct search *search, int32_t accel)
{
    if (wide_to_signed(search->residual) > 0) {
        search_shorten(search, search_quotient(search->residual, search->slope), accel);
    } else {
        search_lengthen(search, search_quotient(0U - search->residual, search->slope), accel);
    }
}

/* However far off the guess is. */
static uint32_t search_from(struct step_generator *generator, uint32_t interval)
{
    int32_t accel = generator->accel;
    struct search search = {.residual = generator->residual - STEP_QUANTA, .slope = generator->slope};
    search_lengthen(&search, interval, accel);
    for (unsigned i = 0; i < CORRECTIONS_MAX && !step_generator_is_near(search.residual, search.slope); i++) {
        search_correct(&search, accel);
    }
    return step_generator_accept(generator, search.residual, search.slope, search.interval);
}

/* At high speeds, where time is short, what was predicted is one tick off. */
uint32_t step_generator_search(struct step_generator *generator, uint32_t interval)
{
    uint64_t accel = wide_from_signed(generator->accel);
    uint64_t gain = wide_from_signed((int64_t)generator->accel * (int32_t)interval);
    uint64_t residual = generator->residual + interval * (generator->slope + gain) - STEP_QUANTA;
    uint64_t slope = generator->slope + 2U * gain;
    if (residual + 2U * slope > 4U * slope) {
        return search_from(generator, interval);
    }
    if (wide_to_signed(residual) > 0) {
        residual -= slope - accel;
        slope -= 2U * accel;
        interval--;
    } else {
        residual += slope + accel;
        slope += 2U * accel;
        interval++;
    }
    return step_generator_is_near(residual, slope) ? step_generator_accept(generator, residual, slope, interval)
                                                   : search_from(generator, interval);
}

void step_generator_aim(struct step_segment *segment, uint32_t interval_ticks)
{
    struct step_generator generator = {
        .residual = segment->residual,
        .slope = segment->slope,
        .accel = segment->accel,
        .tick = segment->tick,
    };
    segment->tick = search_from(&generator, interval_ticks);
    segment->residual = generator.residual;
    segment->slope = generator.slope;
}
