/*
 * The profile of one section: the corners of its speed curve between a speed at its beginning and
 * one at its end.
 *
 * Ramp, cruise, ramp; each may be empty. Squares of speeds stand for speeds: along a ramp they are
 * linear in the distance, so corners are exact fractions of a step. Pure functions.
 */
#ifndef MOTION_PROFILE_H
#define MOTION_PROFILE_H

#include <stdbool.h>
#include <stdint.h>

#include "motion_order.h"
#include "motion_time.h"

/* Half values occur where two ramps meet, so these are twice the squares, in (steps/s)^2. */
struct motion_profile {
    uint64_t enter;               /* at the beginning */
    uint64_t turn;                /* at the end of the first ramp */
    uint64_t cruise;              /* after it: differs from `turn` only where the motor may jump, both below S */
    uint64_t exit;                /* at the end */
    struct motion_place corner_a; /* end of the first ramp */
    struct motion_place corner_b; /* begin of the last ramp */
    uint64_t begin;               /* step */
    uint64_t end;                 /* step */
    uint32_t accel_steps_per_s2;
};

/* What a profile is fitted into: a section, or its part after a stop or a change. */
struct motion_span {
    uint64_t begin; /* steps from the start of the move */
    uint64_t steps;
    uint64_t enter_speed2;      /* (steps/s)^2 */
    uint64_t exit_speed2;       /* can be reached from enter_speed2 within the span */
    uint32_t speed_steps_per_s; /* not exceeded, except while braking down to it */
    uint32_t accel_steps_per_s2;
    uint32_t start_speed_steps_per_s; /* S, where `jumps`: speeds up to it are taken at once */
    bool jumps;
};

static inline uint64_t motion_lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* v^2. */
uint64_t motion_square(uint32_t speed_steps_per_s);

/* 2*A*steps, the change of the square of the speed over a distance; 2^60 if it is more. */
uint64_t motion_gain(uint32_t accel_steps_per_s2, uint64_t steps);

/* The square of the speed with which a span is really begun: a jump at its beginning included, up
 * to a speed that can still be braked to the exit speed. */
uint64_t motion_profile_enter(const struct motion_span *span);

/* The lowest speed (squared) to which the motor must brake in this span before it may go on at
 * once. */
uint64_t motion_profile_floor(const struct motion_span *span);

struct motion_profile motion_profile_fit(const struct motion_span *span);

/* The profile of a stop: a ramp from enter_speed2 down to exit_speed2, and nothing after it. Its
 * end is the last whole step on the ramp. */
struct motion_profile motion_profile_fit_stop(const struct motion_span *span);

#endif
