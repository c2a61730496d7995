/*
 * The break points of a plan's ideal speed curve, for who wants to draw it.
 */
#ifndef MOTION_CORNERS_H
#define MOTION_CORNERS_H

#include <stdint.h>

#include "motion_plan.h"

/* Nearest step, nearest step/s. */
struct motion_corner {
    uint64_t step;
    uint32_t speed_steps_per_s;
};

/* The start, the origin of a stop or change, three a section. */
enum {
    MOTION_CORNERS_MAX = 2 + 3 * MOTION_SECTIONS
};

/* The start of the move (step 1, start speed), the origin of a stop or a change, every corner after
 * it, and the end with speed 0 unless the run is endless. Returns their number. */
unsigned motion_corners_of(const struct motion_plan *plan, struct motion_corner corners[MOTION_CORNERS_MAX]);

#endif
