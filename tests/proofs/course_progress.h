/*
 * How far a course has been laid: contracts of path_course.c, proved with path_course_leg.acsl; to be included after
 * struct progress.
 */
#ifndef COURSE_PROGRESS_H
#define COURSE_PROGRESS_H

#include "course_speeds.h"

/*@ requires \valid(course) && course->legs <= 2 && \valid_read(at) && \separated(course, at);
    assigns course->legs, course->leg[\at(course->legs, Pre)];
    ensures course->legs == \old(course->legs) + 1 && \result == &course->leg[\old(course->legs)];
    ensures \result->time.high == at->time.high && \result->time.low == at->time.low;
    ensures \result->place.high == at->place.high && \result->place.low == at->place.low;
    ensures \result->slope.high == at->slope.high && \result->slope.low == at->slope.low;
    ensures \result->twice_speed2 == at->twice_speed2;
*/
static struct path_leg *begin_leg(struct path_course *course, const struct progress *at);

/*@ requires \valid(at) && speeds_fit(at->speeds) && \separated(at, at->speeds) && twice_speed2 <= twice_speed2_most;
    requires slope_fits(at->twice_speed2, at->slope);
    assigns at->twice_speed2, at->slope, *at->speeds;
    ensures speeds_fit(at->speeds) && at->twice_speed2 == twice_speed2 && slope_fits(twice_speed2, at->slope);
*/
static void set_speed(struct progress *at, uint64_t twice_speed2);

#endif
