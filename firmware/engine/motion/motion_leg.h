/*
 * A leg: one ramp or one cruise of the ideal curve, from corner to corner, and the segment that
 * follows it.
 *
 * Corners lie at real positions and real times. A leg is evaluated from its slow end, where a
 * rounding moves no pulse: half a unit of slope wrong at the fast end of a ramp with A1 from V16000
 * would move its last pulse by thousands of ticks; at the slow end it moves none by more than 1/500
 * tick. Pure functions.
 */
#ifndef MOTION_LEG_H
#define MOTION_LEG_H

#include <stdint.h>

#include "motion_time.h"
#include "../step/step_segment.h"

struct motion_leg {
    struct motion_time start;
    struct motion_time end;
    struct motion_place from; /* its whole steps are the pulses made before the leg */
    struct motion_place to;
    uint64_t from_slope; /* quanta a tick (step_scale.h) */
    uint64_t to_slope;
    uint64_t pulse_twice_speed2; /* of a ramp: twice the square of the speed at its first pulse, (steps/s)^2 */
    uint32_t accel;              /* quanta a tick^2; 0: cruise */
};

/* The slope of a speed, given twice the speed's square in (steps/s)^2, at most 2^56. */
uint64_t motion_leg_slope(uint64_t twice_speed2);

/* Sets the end of a leg from its start: a ramp lasts |to_slope - from_slope| / (2 * accel), a
 * cruise as long as its distance takes at from_slope. */
void motion_leg_set_end(struct motion_leg *leg);

/* Pulses on the leg. */
uint64_t motion_leg_pulses(const struct motion_leg *leg);

/* The segment of a leg that has pulses, at most 2^32 - 1. */
struct step_segment motion_leg_segment(const struct motion_leg *leg);

#endif
