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
 * vectors and what holds for them have no part in it; reference runs and lines ;@pause are counted.
 *
 * With a path a file gets the course of it: of each vector three doubles as the machine has them, X and Y at its end
 * in mm, and how long it takes in s; NaN is a place from which a chain begins. */
enum exit_status gve_plan_input(char *const scales[GVE_PLAN_SCALES], const char *course_path);

#endif
