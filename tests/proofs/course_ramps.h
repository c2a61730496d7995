/*
 * The contract of ramp_time in path_course.c, proved with path_course_ramp.acsl.
 */
#ifndef COURSE_RAMPS_H
#define COURSE_RAMPS_H

#include "courses.h"

/*@ requires \valid_read(course) && is_ready(course->per_accel) && 2 <= number(course->per_accel);
    requires slope_a.high <= 0x70000000000000 && slope_b.high <= 0x70000000000000;
    assigns \nothing;
    ensures \result.high <= 0x38000000000000;
    ensures divided_down(change_of(value(slope_a), value(slope_b)), number(course->per_accel), value(\result));
*/
static struct wide ramp_time(const struct path_course *course, struct wide slope_a, struct wide slope_b);

#endif
