#include "step_lay.h"

/* Both loops work on copies of what changes, which the compiler keeps in registers. */

static unsigned lay_cruise(struct step_generator *generator, const struct hal_step_room *room, unsigned first,
                           unsigned count)
{
    struct hal_step_pulse *pulse = &room->pulse[first];
    const struct hal_step_pulse *end = pulse + count;
    uint64_t residual = generator->residual;
    uint64_t slope = generator->slope;
    uint64_t rest = generator->pace_rest;
    uint32_t tick = generator->tick;
    uint32_t interval;
    do {
        interval = step_generator_pace(&residual, slope, rest, generator->pace_ticks);
        tick += interval;
        pulse->rise_tick = tick;
        pulse->fall_tick = tick + room->high_ticks;
        pulse++;
    } while (pulse != end && step_lay_goes_on(tick, room));
    generator->residual = residual;
    generator->tick = tick;
    generator->interval = interval;
    return count - (unsigned)(end - pulse);
}

/* One tick on, or back, from a prediction that was wrong. */
static inline struct step_guess mend(struct step_guess guess, int32_t accel)
{
    uint64_t gain = wide_from_signed(accel);
    if (wide_to_signed(guess.residual) > 0) {
        guess.residual -= guess.slope - gain;
        guess.slope -= 2U * gain;
        guess.interval--;
    } else {
        guess.residual += guess.slope + gain;
        guess.slope += 2U * gain;
        guess.interval++;
    }
    return guess;
}

static unsigned lay_ramp(struct step_generator *generator, const struct hal_step_room *room, unsigned first,
                         unsigned count)
{
    struct hal_step_pulse *pulse = &room->pulse[first];
    const struct hal_step_pulse *end = pulse + count;
    uint64_t residual = generator->residual;
    uint64_t slope = generator->slope;
    int32_t accel = generator->accel;
    uint32_t tick = generator->tick;
    uint32_t interval = generator->interval;
    do {
        struct step_guess guess = step_generator_guess(residual, slope, accel, interval);
        if (BASE_SELDOM(!step_generator_is_near(guess.residual, guess.slope))) {
            struct step_guess mended = mend(guess, accel);
            if (!step_generator_is_near(mended.residual, mended.slope)) {
                generator->residual = residual;
                generator->slope = slope;
                (void)step_generator_search(generator, guess.interval);
                mended = (struct step_guess){generator->residual, generator->slope, generator->interval};
            }
            guess = mended;
        }
        residual = guess.residual;
        slope = guess.slope;
        interval = guess.interval;
        tick += interval;
        pulse->rise_tick = tick;
        pulse->fall_tick = tick + room->high_ticks;
        pulse++;
    } while (pulse != end && step_lay_goes_on(tick, room));
    generator->residual = residual;
    generator->slope = slope;
    generator->tick = tick;
    generator->interval = interval;
    return count - (unsigned)(end - pulse);
}

unsigned step_lay(struct step_generator *generator, const struct hal_step_room *room, unsigned first, unsigned count)
{
    return generator->accel != 0 ? lay_ramp(generator, room, first, count) : lay_cruise(generator, room, first, count);
}
