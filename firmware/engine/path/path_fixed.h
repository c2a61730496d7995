/*
 * Numbers of 64 whole bits and 64 fractional ones, as struct wide: `high` is the whole part, `low` counts 2^-64.
 *
 * Times of a path are ticks in it, its speeds quanta a tick (step_scale.h), paces ticks a step. So fine that a path of
 * 10^8 vectors adds up no rounding that a pulse could show. Pure functions; not for the step interrupt.
 */
#ifndef PATH_FIXED_H
#define PATH_FIXED_H

#include <stdint.h>

#include "base_wide.h"
#include "path_wide.h"

/* Ticks that stand for "never": 1700 years. */
#define PATH_FIXED_NEVER (UINT64_C(1) << 62)

/* A whole number divided, rounded down. The divisor is 1 to 2^63, the quotient below 2^64. */
struct wide path_fixed_divide(struct wide dividend, uint64_t divisor);

/* A product of two fixed-point numbers, at most 3 * 2^-64 too low; PATH_FIXED_NEVER if its whole parts make more. One
 * of them is below 2^62. */
struct wide path_fixed_multiply(struct wide a, struct wide b);

/* The speed whose square is `twice_speed2` / 2 (path_vector.h) in quanta a tick, 2^-60 off at most. The square is at
 * most 2 * PATH_SPEED_MAX^2. */
struct wide path_fixed_slope(uint64_t twice_speed2);

/* Ticks a step at a speed in quanta a tick, at least 2^20; 2^-62 of it off at most. */
struct wide path_fixed_pace(struct wide slope);

#endif
