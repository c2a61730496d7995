/*
 * The units of the step generator: integers in which a ramp is exact.
 *
 * With f ticks a second, a motor at v steps/s under A steps/s^2 covers v*T/f + A*T^2/(2*f^2) steps
 * in T ticks. Times 2*f^2 all of it is whole: one step is 2*f^2, a speed v gains 2*f*v in a tick,
 * and the square of T has the factor A. STEP_FRACTION_BITS more bits hold what is not whole: speeds
 * at the borders of compound moves and parts of a tick.
 *
 *   quanta   position: STEP_QUANTA of them are one step
 *   slope    quanta a tick: speed * STEP_SLOPE_PER_SPEED
 *   accel    quanta a tick^2, half the second derivative: acceleration * STEP_ACCEL_PER_ACCEL
 *
 *   position(T) = position(0) + slope*T + accel*T^2        slope(T) = slope(0) + 2*accel*T
 *
 * Positions and slopes are kept modulo 2^64: the differences that matter are small, so what wraps
 * is never missed.
 */
#ifndef STEP_SCALE_H
#define STEP_SCALE_H

#include <assert.h>
#include <stdint.h>

#include "base_tick.h"

#define STEP_FRACTION_BITS 7U
#define STEP_ACCEL_PER_ACCEL (UINT32_C(1) << STEP_FRACTION_BITS)
#define STEP_SLOPE_PER_SPEED ((UINT64_C(2) * TICK_HZ) << STEP_FRACTION_BITS)
#define STEP_QUANTA (STEP_SLOPE_PER_SPEED * TICK_HZ)

/* Top speed and acceleration that the generator is built for; units stay far below. */
#define STEP_SPEED_MAX UINT32_C(1000000)
#define STEP_ACCEL_MAX UINT32_C(8000000)

static_assert(STEP_SLOPE_PER_SPEED <= (UINT64_C(1) << 61) / TICK_HZ, "a residual of two steps must fit 63 bits");
static_assert(STEP_ACCEL_MAX <= (UINT32_C(1) << 30) / STEP_ACCEL_PER_ACCEL, "2 * accel must fit 31 bits");
static_assert(STEP_SPEED_MAX <= (UINT64_C(1) << 61) / STEP_SLOPE_PER_SPEED, "a slope must leave two bits free");

#endif
