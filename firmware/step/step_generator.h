/*
 * The step generator: yields the tick of each pulse of a segment, rounded to the nearest, without accumulated error.
 *
 * State is the exact position and slope at the last pulse's tick. To find the next pulse it foretells the interval
 * from the last two, evaluates the exact position after it, and corrects it until the position is within half a tick's
 * way of the next whole step. The foretelling knows how far each pulse lies from its exact time, so on a ramp nine
 * pulses of ten need no correction and most others one tick; only near a stand does it divide.
 * Pure arithmetic: no queue, no pin, no clock. Called from the step interrupt; the planner calls it on copies.
 */
#ifndef STEP_GENERATOR_H
#define STEP_GENERATOR_H

#include <stdint.h>

#include "step_segment.h"

/* The longest interval between two pulses: 1.6 s, a motor at 0.63 steps/s. */
#define STEP_INTERVAL_TICKS_MAX ((UINT32_C(1) << 27) - 1U)

struct step_generator {
    uint64_t residual; /* position at `tick`, less the pulses found so far; within half a tick's way of 0 */
    uint64_t slope;    /* quanta a tick, at `tick` */
    int32_t accel;     /* quanta a tick^2 */
    uint32_t tick;     /* of the last pulse, or of the start */
    uint32_t interval; /* from the pulse before, ticks */

    /* What foretells the next interval; in 1/32 ticks, and only as exact as that. */
    uint32_t period;   /* exact time from the pulse before to the last one */
    uint32_t change;   /* what each period adds to the one before, modulo 2^32 */
    int32_t lag;       /* tick of the last pulse less its exact time */
};

/* Stands still at `tick`, on a whole step. */
void step_generator_start(struct step_generator *generator, uint32_t tick);

/* Goes on with a segment from the present pulse. */
void step_generator_load(struct step_generator *generator, const struct step_segment *segment);

/* Moves on to the next pulse and returns its tick. There must be one: the position must reach the next step, within
 * STEP_INTERVAL_TICKS_MAX. */
uint32_t step_generator_next(struct step_generator *generator);

#endif
