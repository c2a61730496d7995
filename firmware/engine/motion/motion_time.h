/*
 * The planner's time and place: finer than ticks and steps, so that nothing the step generator sees
 * is rounded twice. Pure functions.
 */
#ifndef MOTION_TIME_H
#define MOTION_TIME_H

#include <stdbool.h>
#include <stdint.h>

#include "base_wide.h"

/* Ticks of the unit's time + fraction / 2^32. */
struct motion_time {
    uint64_t ticks;
    uint32_t fraction;
};

/* Steps from the start of the move + quanta / STEP_QUANTA. */
struct motion_place {
    uint64_t step;
    uint64_t quanta; /* 0 to STEP_QUANTA - 1 */
};

/* time + dividend / divisor, rounded down to the fraction. The divisor is 1 to 2^63, the quotient
 * below 2^64. */
struct motion_time motion_time_add(struct motion_time time, struct wide dividend, uint64_t divisor);

/* The whole tick at or after a time. */
uint64_t motion_time_up(struct motion_time time);

/* The distance from place a to place b, not before a, in quanta. */
struct wide motion_place_distance(struct motion_place a, struct motion_place b);

bool motion_place_is_same(struct motion_place a, struct motion_place b);

/* step + numerator / denominator steps, rounded to the nearest quantum; the denominator is 1 to
 * 2^32. */
struct motion_place motion_place_add(uint64_t step, uint64_t numerator, uint64_t denominator);

/* step - numerator / denominator steps, likewise; not below 0. */
struct motion_place motion_place_subtract(uint64_t step, uint64_t numerator, uint64_t denominator);

#endif
