/*
 * The step generator: yields the tick of each pulse of a segment, rounded to the nearest, without
 * accumulated error.
 *
 * State is the exact position and slope at the last pulse's tick. On a ramp it predicts the next
 * interval from the speed in the middle of it, evaluates the exact position after it, and corrects
 * it until the position is within half a tick's travel of the next whole step. The prediction has
 * the digits of 32-bit words: above some thousand steps/s it is nearly always right; below, where
 * there is time, it is a tick or more off and the search goes on with division. At constant speed
 * every interval is the same whole number of ticks or one more, and the position decides which.
 * Pure arithmetic: no queue, no pin, no clock. Called from the step interrupt, for which the usual
 * cases are inline; the planner calls it on copies.
 */
#ifndef STEP_GENERATOR_H
#define STEP_GENERATOR_H

#include <stdbool.h>
#include <stdint.h>

#include "base_hint.h"
#include "base_wide.h"
#include "step_scale.h"
#include "step_segment.h"

/* The longest interval between two pulses: 1.6 s, a motor at 0.63 steps/s. */
#define STEP_INTERVAL_TICKS_MAX ((UINT32_C(1) << 27) - 1U)

struct step_generator {
    uint64_t residual; /* position at `tick`, less the pulses found so far; within half a tick's travel of 0 */
    uint64_t slope;    /* quanta a tick, at `tick` */
    int32_t accel;     /* quanta a tick^2 */
    uint32_t tick;     /* of the last pulse, or of the start */
    uint32_t interval; /* from the pulse before, ticks; on a segment's first pulse what that tells, if it does */

    /* At constant speed: the whole ticks of a step's time, and the part of the step that they
     * leave. */
    uint32_t pace_ticks;
    uint64_t pace_rest;
};

/* Stands still at `tick`, on a whole step. */
void step_generator_start(struct step_generator *generator, uint32_t tick);

/* Stays on its pulse, which lies on a segment too: the segment's first `made` pulses have been
 * made. */
void step_generator_join(struct step_generator *generator, const struct step_segment *segment, uint32_t made);

/* Moves a segment to its first pulse from a moment up to 25 s before it: coming in, residual and
 * slope are those at `tick`, and no pulse has been made. The first pulse comes about
 * `interval_ticks` later; nearer is found faster. */
void step_generator_aim(struct step_segment *segment, uint32_t interval_ticks);

/* Moves on to the next pulse where the prediction, `interval` ticks after the last one, was
 * wrong. */
uint32_t step_generator_search(struct step_generator *generator, uint32_t interval);

/* Takes over what a segment says of all its pulses. */
static inline void step_generator_take_motion(struct step_generator *generator, const struct step_segment *segment)
{
    generator->accel = segment->accel;
    if (segment->accel == 0) {
        generator->pace_ticks = segment->pace_ticks;
        generator->pace_rest = STEP_QUANTA - segment->pace_ticks * segment->slope;
    }
}

/* Goes on with a segment, on its first pulse. */
static inline void step_generator_load(struct step_generator *generator, const struct step_segment *segment)
{
    bool told = segment->accel != 0 && segment->pace_ticks != 0;
    uint32_t interval = segment->tick - generator->tick;
    step_generator_take_motion(generator, segment);
    generator->residual = segment->residual;
    generator->slope = segment->slope;
    generator->interval = told ? segment->pace_ticks : interval;
    generator->tick = segment->tick;
}

/* Takes the position and slope after `interval` ticks for those of the next pulse. */
static inline uint32_t step_generator_accept(struct step_generator *generator, uint64_t residual, uint64_t slope,
                                             uint32_t interval)
{
    generator->residual = residual;
    generator->slope = slope;
    generator->interval = interval;
    generator->tick += interval;
    return generator->tick;
}

/* Whether a position is within half a tick's travel of a whole step. */
static inline bool step_generator_is_near(uint64_t residual, uint64_t slope)
{
    return residual + (slope >> 1U) <= slope;
}

/* The time to the next step at a speed, from the high words of both; to the nearest tick. */
static inline uint32_t step_generator_predict(uint64_t residual, uint64_t slope)
{
    uint32_t distance = (uint32_t)(STEP_QUANTA >> 32U) - (uint32_t)(residual >> 32U);
    uint32_t speed = ((uint32_t)(slope >> 32U) + ((uint32_t)slope >> 31U)) | 1U;
    return (distance + speed / 2U) / speed;
}

/* Where the prediction of the next interval leads to. */
struct step_guess {
    uint64_t residual;
    uint64_t slope;
    uint32_t interval;
};

static inline struct step_guess step_generator_guess(uint64_t residual, uint64_t slope, int32_t accel,
                                                     uint32_t last_interval)
{
    uint64_t about = slope + wide_from_signed((int64_t)accel * (int32_t)last_interval);
    uint32_t interval = step_generator_predict(residual, about);
    uint64_t gain = wide_from_signed((int64_t)accel * (int32_t)interval);
    uint64_t middle = slope + gain;
    return (struct step_guess){
        .residual = residual + interval * middle - STEP_QUANTA,
        .slope = middle + gain,
        .interval = interval,
    };
}

/* The next pulse of a segment with acceleration. */
static inline uint32_t step_generator_ramp(struct step_generator *generator)
{
    struct step_guess guess =
        step_generator_guess(generator->residual, generator->slope, generator->accel, generator->interval);
    if (BASE_SELDOM(!step_generator_is_near(guess.residual, guess.slope))) {
        return step_generator_search(generator, guess.interval);
    }
    return step_generator_accept(generator, guess.residual, guess.slope, guess.interval);
}

/* The next interval at constant speed: what the pace leaves of each step adds up in the residual, until it exceeds
 * half a tick's travel. */
static inline uint32_t step_generator_pace(uint64_t *residual, uint64_t slope, uint64_t rest, uint32_t ticks)
{
    *residual -= rest;
    if (wide_to_signed(*residual + (slope >> 1U)) < 0) {
        *residual += slope;
        ticks++;
    }
    return ticks;
}

/* The next pulse at constant speed. */
static inline uint32_t step_generator_cruise(struct step_generator *generator)
{
    uint64_t residual = generator->residual;
    uint32_t interval = step_generator_pace(&residual, generator->slope, generator->pace_rest, generator->pace_ticks);
    return step_generator_accept(generator, residual, generator->slope, interval);
}

/* Moves on to the next pulse of a segment and returns its tick. There must be one: the position
 * must reach the next step, within STEP_INTERVAL_TICKS_MAX. */
static inline uint32_t step_generator_next(struct step_generator *generator)
{
    return generator->accel != 0 ? step_generator_ramp(generator) : step_generator_cruise(generator);
}

#endif
