/*
 * A point of a move at which time and speed are known exactly: always at a whole step, where the
 * square of the speed is a whole number.
 */
#ifndef MOTION_POINT_H
#define MOTION_POINT_H

#include <stdint.h>

#include "motion_time.h"
#include "../step/step_cursor.h"

struct motion_point {
    struct motion_time time;
    uint64_t step;   /* pulses made from the start of the move until here */
    uint64_t speed2; /* square of the speed, (steps/s)^2 */
};

/* The point at which the generator of a cursor stands: its pulse, the exact time of which the
 * pulse's tick is the rounding, and its exact speed. `near_ticks` is the unit's time within 25 s.
 * Pure. */
struct motion_point motion_point_of(const struct step_cursor *cursor, uint64_t near_ticks);

#endif
