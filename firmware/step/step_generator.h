/*
 * The step generator: yields the tick of each pulse of a segment, rounded to the nearest, without accumulated error.
 *
 * State is the exact position and slope at the last pulse's tick. To find the next pulse it guesses the interval c
 * from the last two, evaluates position(c) exactly, and corrects c by Newton's rule until the position is within half
 * a tick's way of the next whole step: mostly no correction or one, and no division where one tick mends it.
 * Pure arithmetic: no queue, no pin, no clock. Called from the step interrupt; the planner calls it on copies.
 */
#ifndef STEP_GENERATOR_H
#define STEP_GENERATOR_H

#include <stdint.h>

#include "step_segment.h"

struct step_generator {
    uint64_t residual;  /* position at `tick`, less the pulses found so far; within half a tick's way of 0 */
    uint64_t slope;     /* quanta a tick, at `tick` */
    int32_t accel;      /* quanta a tick^2 */
    uint32_t tick;      /* of the last pulse, or of the start */
    uint32_t interval;  /* first guess of the next interval, ticks */
    uint32_t change;    /* what each interval adds to the one before, ticks; modulo 2^32 */
};

/* Stands still at `tick`, on a whole step. */
void step_generator_start(struct step_generator *generator, uint32_t tick);

/* Goes on with a segment from the present pulse. */
void step_generator_load(struct step_generator *generator, const struct step_segment *segment);

/* Moves on to the next pulse and returns its tick. There must be one: the position must reach the next step. */
uint32_t step_generator_next(struct step_generator *generator);

#endif
