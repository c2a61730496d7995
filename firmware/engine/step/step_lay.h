/*
 * Lays the pulses of one segment: the generator's ticks, as edges, into the room that the backend gives. The innermost
 * loop of the firmware, part of its caller. Step interrupt, or with hal_step held.
 */
#ifndef STEP_LAY_H
#define STEP_LAY_H

#include "base_hint.h"
#include "base_wide.h"
#include "hal_step.h"
#include "step_generator.h"

/* Whether a pulse after the one at `tick` is wanted: tick_is_before, without a call. */
static inline bool step_lay_goes_on(uint32_t tick, uint32_t until_tick)
{
    return until_tick - tick - 1U < UINT32_C(1) << 31U;
}

/* Lays the pulse that the generator stands on. */
static inline void step_lay_pulse(const struct step_generator *generator, const struct hal_step_room *room,
                                  unsigned place)
{
    room->pulse[place].rise_tick = generator->tick;
    room->pulse[place].fall_tick = generator->tick + room->high_ticks;
}

/* Finds the pulse for which a guess was wrong, from the pulse before it, which the generator has forgotten: position,
 * slope and interval go out. */
void step_lay_search(struct step_generator *generator, struct step_guess guess);

/* All loops work on copies of what changes, which the compiler keeps in registers. At constant speed: what
 * step_generator_pace does, with half a tick's travel in the residual. */
static inline unsigned step_lay_cruise(struct step_generator *generator, const struct hal_step_room *room,
                                       unsigned first, unsigned count)
{
    struct hal_step_pulse *pulse = &room->pulse[first];
    unsigned left = count;
    uint64_t slope = generator->slope;
    uint64_t rest = generator->pace_rest;
    uint64_t way = generator->residual + (slope >> 1U);
    uint32_t tick = generator->tick;
    uint32_t high_ticks = room->high_ticks;
    uint32_t until_tick = room->until_tick;
    uint32_t interval;
    do {
        interval = generator->pace_ticks;
        way -= rest;
        if (wide_to_signed(way) < 0) {
            way += slope;
            interval++;
        }
        tick += interval;
        pulse->rise_tick = tick;
        pulse->fall_tick = tick + high_ticks;
        pulse++;
        left--;
    } while (left != 0U && step_lay_goes_on(tick, until_tick));
    generator->residual = way - (slope >> 1U);
    generator->tick = tick;
    generator->interval = interval;
    return count - left;
}

/* Whether the high words alone say that a position is near. On a ramp a speed is half a step/s at least, so that of it
 * is not 0 (tests/proofs/README.md). */
static inline bool step_lay_is_surely_near(uint64_t residual, uint64_t slope)
{
    uint32_t speed = (uint32_t)(slope >> 32U);
    uint32_t way = (uint32_t)(residual >> 32U) + speed / 2U;
    return way < speed - 1U;
}

/* One tick on, or back, from a prediction that was wrong. */
static inline struct step_guess step_lay_mend(struct step_guess guess, int32_t accel)
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

/* The pulse before is not kept, so that a search has to go back to it. */
static inline unsigned step_lay_ramp(struct step_generator *generator, const struct hal_step_room *room, unsigned first,
                                     unsigned count)
{
    struct hal_step_pulse *pulse = &room->pulse[first];
    unsigned left = count;
    struct step_guess at = {generator->residual, generator->slope, generator->interval};
    int32_t accel = generator->accel;
    uint32_t tick = generator->tick;
    uint32_t high_ticks = room->high_ticks;
    uint32_t until_tick = room->until_tick;
    do {
        at = step_generator_guess(at.residual, at.slope, accel, at.interval);
        if (BASE_SELDOM(!step_lay_is_surely_near(at.residual, at.slope)) &&
            !step_generator_is_near(at.residual, at.slope)) {
            at = step_lay_mend(at, accel);
            if (!step_generator_is_near(at.residual, at.slope)) {
                step_lay_search(generator, at);
                at = (struct step_guess){generator->residual, generator->slope, generator->interval};
            }
        }
        tick += at.interval;
        pulse->rise_tick = tick;
        pulse->fall_tick = tick + high_ticks;
        pulse++;
        left--;
    } while (left != 0U && step_lay_goes_on(tick, until_tick));
    generator->residual = at.residual;
    generator->slope = at.slope;
    generator->tick = tick;
    generator->interval = at.interval;
    return count - left;
}

/* Lays at least one pulse from place `first` of the room on, at most `count`, none after the first that is due at
 * room->until_tick or later. The segment has `count` pulses left at least, and the room as many places. Returns how
 * many. */
static inline unsigned step_lay(struct step_generator *generator, const struct hal_step_room *room, unsigned first,
                                unsigned count)
{
    return generator->accel != 0 ? step_lay_ramp(generator, room, first, count)
                                 : step_lay_cruise(generator, room, first, count);
}

#endif
