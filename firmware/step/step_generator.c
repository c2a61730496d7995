#include "step_generator.h"

#include "base_wide.h"
#include "step_scale.h"

enum {
    /* Newton's rule doubles the exact digits, except near a stand, where it halves the error; 32 bits of interval
     * and the bits of a division end it long before. */
    CORRECTIONS_MAX = 48,
};

/* Where the search stands: position and slope after `interval` ticks. */
struct search {
    int64_t residual;
    int64_t slope;
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

    generator->accel = segment->accel;
    generator->residual = segment->residual + shift * (segment->slope + accel * shift);
    generator->slope = segment->slope + 2U * accel * shift;
    generator->interval = segment->tick + segment->interval_ticks - generator->tick;
    generator->change = 0;
}

/* residual / slope, away from 0, at least 1 in size; about 16 good bits. Both are shifted until they fit 32 bits. */
static int32_t search_quotient(int64_t residual, int64_t slope)
{
    uint64_t size = residual < 0 ? (uint64_t)-residual : (uint64_t)residual;
    uint64_t divisor = (uint64_t)slope;
    uint32_t high = (uint32_t)((size | divisor) >> 32U);
    unsigned shift = 0;
    while (high != 0) {
        high >>= 1U;
        shift++;
    }
    uint32_t short_divisor = (uint32_t)(divisor >> shift);
    uint32_t quotient = (uint32_t)(size >> shift) / (short_divisor != 0 ? short_divisor : 1U);
    int32_t bounded = quotient == 0 ? 1 : quotient > INT32_MAX ? INT32_MAX : (int32_t)quotient;
    return residual < 0 ? -bounded : bounded;
}

static void search_correct(struct search *search, int32_t accel)
{
    for (unsigned i = 0; i < CORRECTIONS_MAX; i++) {
        int64_t half = search->slope >> 1U;
        if (search->residual <= half && search->residual > -half) {
            return;
        }
        int64_t ticks = search_quotient(search->residual, search->slope);
        int64_t gain = accel * ticks;
        search->residual -= ticks * (search->slope - gain);
        search->slope -= 2 * gain;
        search->interval -= (uint32_t)ticks;
    }
}

/* The guess for the interval after this one: as much longer or shorter as this one was, but never below half: at
 * the start of a ramp from a stand the intervals shrink faster than that only once. */
static uint32_t guess_change(uint32_t interval, uint32_t last)
{
    uint32_t change = interval - last;
    return last > interval && last - interval > interval / 2U ? 0U - interval / 2U : change;
}

uint32_t step_generator_next(struct step_generator *generator)
{
    uint32_t guess = generator->interval + generator->change;
    uint64_t gain = wide_from_signed((int64_t)generator->accel * guess);
    uint64_t middle = generator->slope + gain;
    struct search search = {
        .residual = wide_to_signed(generator->residual + guess * middle - STEP_QUANTA),
        .slope = wide_to_signed(middle + gain),
        .interval = guess,
    };
    search_correct(&search, generator->accel);

    generator->residual = wide_from_signed(search.residual);
    generator->slope = wide_from_signed(search.slope);
    if (generator->accel != 0) {
        generator->change = guess_change(search.interval, generator->interval);
    }
    generator->interval = search.interval;
    generator->tick += search.interval;
    return generator->tick;
}
