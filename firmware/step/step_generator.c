#include "step_generator.h"

#include "base_tick.h"

enum {
    /* Newton's rule doubles the exact digits, except near a stand, where it halves the error; 32 bits of interval
     * and the bits of a division end it long before. */
    CORRECTIONS_MAX = 48,
};

void step_generator_start(struct step_generator *generator, uint32_t tick)
{
    *generator = (struct step_generator){.tick = tick};
}

static void take_motion(struct step_generator *generator, const struct step_segment *segment)
{
    generator->accel = segment->accel;
    generator->pace_ticks = segment->pace_ticks;
    generator->pace_rest = STEP_QUANTA - segment->pace_ticks * segment->slope;
}

void step_generator_load(struct step_generator *generator, const struct step_segment *segment)
{
    take_motion(generator, segment);
    generator->residual = segment->residual;
    generator->slope = segment->slope;
    generator->interval = segment->tick - generator->tick;
    generator->tick = segment->tick;
}

void step_generator_join(struct step_generator *generator, const struct step_segment *segment, uint32_t made)
{
    uint64_t accel = wide_from_signed(segment->accel);
    uint64_t shift = wide_from_signed(tick_difference(generator->tick, segment->tick));
    take_motion(generator, segment);
    generator->residual = segment->residual + shift * (segment->slope + accel * shift) + STEP_QUANTA - made * STEP_QUANTA;
    generator->slope = segment->slope + 2U * accel * shift;
}

void step_generator_aim(struct step_segment *segment, uint32_t interval_ticks)
{
    struct step_generator generator = {
        .residual = segment->residual,
        .slope = segment->slope,
        .accel = segment->accel,
        .tick = segment->tick,
    };
    segment->tick = step_generator_search(&generator, interval_ticks);
    segment->residual = generator.residual;
    segment->slope = generator.slope;
}

/* Where the search for a pulse stands: position and slope after `interval` ticks. */
struct search {
    uint64_t residual;
    uint64_t slope;
    uint32_t interval;
};

static void search_lengthen(struct search *search, int64_t ticks, int32_t accel)
{
    uint64_t gain = wide_from_signed(accel * ticks);
    search->residual += wide_from_signed(ticks) * (search->slope + gain);
    search->slope += 2U * gain;
    search->interval += (uint32_t)wide_from_signed(ticks);
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
    bool late = wide_to_signed(search->residual) > 0;
    uint64_t distance = late ? search->residual : 0U - search->residual;
    int64_t ticks = distance <= search->slope ? 1 : search_quotient(distance, search->slope);
    search_lengthen(search, late ? -ticks : ticks, accel);
}

uint32_t step_generator_search(struct step_generator *generator, uint32_t interval)
{
    struct search search = {.residual = generator->residual - STEP_QUANTA, .slope = generator->slope};
    search_lengthen(&search, interval, generator->accel);
    for (unsigned i = 0; i < CORRECTIONS_MAX && !step_generator_is_near(search.residual, search.slope); i++) {
        search_correct(&search, generator->accel);
    }
    return step_generator_accept(generator, search.residual, search.slope, search.interval);
}
