/*
 * Segments of one axis from the course of a path: the path's motion scaled by the axis' share, steps / L, and rounded.
 *
 * The roundings are half a quantum of position, of slope and, where the share makes a fraction, of acceleration, so T
 * ticks after its first pulse a segment is (1 + T + T^2) / 2 quanta off at most. It ends before that is an eighth of
 * the slope, that is an eighth of a tick, and the next one begins on the exact path again. Pure functions; main or plan
 * interrupt.
 */
#ifndef PATH_SEGMENT_H
#define PATH_SEGMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "path_course.h"
#include "../step/step_segment.h"

/* What an axis does on a leg, from one of its pulses on. */
struct path_stretch {
    uint32_t steps; /* of the axis in the vector */
    uint32_t pulse; /* in the vector, from 1 */
    uint32_t last;  /* the last one on the leg */
};

/* The segment that begins with the pulse `at` of a stretch. The generator finds every further pulse of it, whatever
 * came before. */
struct step_segment path_segment_lay(const struct path_course *course, const struct path_leg *leg,
                                     const struct path_stretch *stretch, const struct path_pulse *at);

/* The whole tick of a pulse. */
uint64_t path_segment_tick(const struct path_pulse *pulse);

#endif
