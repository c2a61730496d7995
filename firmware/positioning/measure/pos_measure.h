/*
 * Measures: the numbers of a PLC, in millimetres and micrometres, as numbers of the motion, in steps; and back. All are
 * rounded once, to the nearest, halves up, so nothing depends on where a count begins. Pure; may be called from
 * anywhere.
 *
 *   feed      1/65 536 mm/min
 *   speed     1/256 step/s
 *   accel     mm/s^2 of a PLC, 1/128 step/s^2 of the motion
 */
#ifndef POS_MEASURE_H
#define POS_MEASURE_H

#include <stdint.h>

/* An axis makes `steps` steps in `micrometres` um: 1 to 2^31 - 1 each, the quotient 1/10 000 to 500. */
struct pos_scale {
    uint32_t steps;
    uint32_t micrometres;
};

/* Places have to stay in these bounds: twice a place times a number of the scale must fit the arithmetic. */
#define POS_MEASURE_UM_MAX (INT64_C(1) << 62)

/* The speed of a feed, at most `highest`; 0 of feed 0 alone. */
uint32_t pos_measure_speed(const struct pos_scale *scale, uint32_t feed, uint32_t highest);

/* The acceleration, at most `highest`; 0 of 0 alone. */
uint32_t pos_measure_accel(const struct pos_scale *scale, uint32_t accel_mm_s2, uint32_t highest);

/* The feed of a speed; UINT32_MAX if it is more. */
uint32_t pos_measure_feed(const struct pos_scale *scale, uint32_t speed);

/* The step of a way in micrometres, up to POS_MEASURE_UM_MAX both ways. */
int64_t pos_measure_step(const struct pos_scale *scale, int64_t way_um);

/* The way in micrometres to a step. */
int64_t pos_measure_um(const struct pos_scale *scale, int64_t step);

/* The last step whose way is no more than `way_um`, and the first one whose way is no less. */
int64_t pos_measure_last_step(const struct pos_scale *scale, int64_t way_um);
int64_t pos_measure_first_step(const struct pos_scale *scale, int64_t way_um);

#endif
