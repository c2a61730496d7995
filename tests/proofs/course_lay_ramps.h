/*
 * The contract of lay_ramp in path_course.c, proved with path_course_lay_ramp.acsl; to be included after struct
 * progress.
 */
#ifndef COURSE_LAY_RAMPS_H
#define COURSE_LAY_RAMPS_H

#include "course_kept.h"
#include "course_legs.h"
#include "course_speeds.h"

/*@ predicate ramp_leg(struct path_leg *l, integer accel) =
        l->accel != 0 && -accel <= l->accel <= accel && ramp_squares(l);
*/

/*@ requires \valid(course) && course->legs <= 2 && \valid(at) && speeds_fit(at->speeds);
    requires slope_fits(at->twice_speed2, at->slope);
    requires \separated(course, at, at->speeds) && 1 <= accel <= PATH_ACCEL_MAX && to <= twice_speed2_most;
    requires at->time.high <= 0x8000000000000000;
    requires value(at->place) + change_of(at->twice_speed2, to) <= value(course->end);
    assigns course->legs, course->leg[\at(course->legs, Pre)], course->per_accel, at->time, at->place, at->slope,
        at->twice_speed2, *at->speeds;
    ensures speeds_fit(at->speeds) && at->twice_speed2 == to && slope_fits(at->twice_speed2, at->slope);
    ensures value(at->place) == \old(value(at->place)) + change_of(\old(at->twice_speed2), to);
    ensures \old(value(at->time)) <= value(at->time) && at->time.high <= \old(at->time.high) + 0x38000000000001;
    ensures course->legs == (\old(at->twice_speed2) == to ? \old(course->legs) : \old(course->legs) + 1);
    ensures course_kept{Pre,Post}(course);
    ensures 1 <= \old(course->legs) ==> first_kept{Pre,Post}(course);
    ensures 2 <= \old(course->legs) ==> second_kept{Pre,Post}(course);
    ensures \old(at->twice_speed2) == to ==> value(at->time) == \old(value(at->time));
    ensures \old(at->twice_speed2) != to || \old(ramps_ready(course)) ==> ramps_ready(course);
    ensures \old(at->twice_speed2) != to ==> ramp_leg(&course->leg[\old(course->legs)], accel) &&
        value(course->leg[\old(course->legs)].place) == \old(value(at->place)) &&
        value(course->leg[\old(course->legs)].time) == \old(value(at->time)) &&
        value(course->leg[\old(course->legs)].end) == value(at->place);
*/
static void lay_ramp(struct path_course *course, struct progress *at, uint64_t to, uint32_t accel);

#endif
