/*
 * `plan`: how long a vector file takes and how fast it becomes, by the planner of the firmware and without a pulse.
 */
#ifndef GVE_PLAN_H
#define GVE_PLAN_H

#include "complain.h"

enum {
    GVE_PLAN_SCALES = 3 /* pulses a mm of X, Y and Z */
};

/* Reads lines from standard input, whatever their number, and prints one JSON object. Lines that ask for more than
 * vectors and what holds for them have no part in it; reference runs and lines ;@pause are counted. */
enum exit_status gve_plan_input(char *const scales[GVE_PLAN_SCALES]);

#endif
