/*
 * The contract of lay_cruise in path_course.c, proved with path_course_lay_cruise.acsl; to be included after struct
 * progress.
 */
#ifndef COURSE_LAY_CRUISES_H
#define COURSE_LAY_CRUISES_H

#include "course_kept.h"
#include "course_legs.h"
#include "course_speeds.h"

/*@ predicate still_laid(struct path_leg *l) = l->accel == 0;
    predicate slope_laid(struct path_leg *l) = l->slope.high <= 0x70000000000000;
    predicate begin_laid(struct path_course *c, struct path_leg *l) =
        value(l->begin) * c->grains_per_step <= value(l->place) * 0x10000000000000000;
    predicate cruise_leg(struct path_course *c, struct path_leg *l) =
        still_laid(l) && cruise_fits(l) && slope_laid(l) && begin_laid(c, l);
*/

/*@ requires \valid(course) && course->legs <= 2 && course_fits(course) && \valid(at) && speeds_fit(at->speeds);
    requires slope_fits(at->twice_speed2, at->slope);
    requires \separated(course, at, at->speeds) && at->time.high <= 0x4040000000000000;
    requires value(end) <= course_way(course) && (value(at->place) < value(end) ==> 1 <= at->twice_speed2);
    assigns course->legs, course->leg[\at(course->legs, Pre)], at->time, at->place, *at->speeds;
    ensures speeds_fit(at->speeds);
    ensures value(at->place) == greater(\old(value(at->place)), value(end));
    ensures \old(value(at->time)) <= value(at->time);
    ensures at->time.high <= 0x8000000000000000;
    ensures course->legs == (value(end) <= \old(value(at->place)) ? \old(course->legs) : \old(course->legs) + 1);
    ensures course_kept{Pre,Post}(course);
    ensures accel_kept{Pre,Post}(course);
    ensures 1 <= \old(course->legs) ==> first_kept{Pre,Post}(course);
    ensures 2 <= \old(course->legs) ==> second_kept{Pre,Post}(course);
    ensures value(end) <= \old(value(at->place)) ==> value(at->time) == \old(value(at->time));
    ensures \old(value(at->place)) < value(end) ==> cruise_leg(course, &course->leg[\old(course->legs)]);
    ensures \old(value(at->place)) < value(end) ==>
        value(course->leg[\old(course->legs)].place) == \old(value(at->place));
    ensures \old(value(at->place)) < value(end) ==>
        value(course->leg[\old(course->legs)].time) == \old(value(at->time));
    ensures \old(value(at->place)) < value(end) ==>
        value(course->leg[\old(course->legs)].end) == value(at->place);
    ensures \old(value(at->place)) < value(end) ==>
        course->leg[\old(course->legs)].twice_speed2 == at->twice_speed2 &&
        course->leg[\old(course->legs)].slope.high == at->slope.high;
*/
static void lay_cruise(struct path_course *course, struct progress *at, struct wide end);

#endif
