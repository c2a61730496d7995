/*
 * Contracts of cruises in path_course.c, proved with path_course_cruise.acsl.
 */
#ifndef COURSE_CRUISES_H
#define COURSE_CRUISES_H

#include "courses.h"

/*@ predicate cruise_fits(struct path_leg *leg) =
        leg->time.high <= 0x8000000000000000 && leg->pace.high < 0x40000000000 &&
        leg->twice_speed2 <= twice_speed2_most;
*/

/*@ requires \valid_read(course) && course_fits(course) && value(place) <= course_way(course);
    assigns \nothing;
    ensures value(\result) <= course->length * 0x10000000000000000;
    ensures divided_down(value(place) * 0x10000000000000000, course->grains_per_step, value(\result));
*/
static struct wide steps_of(const struct path_course *course, struct wide place);

/*@ requires \valid_read(leg) && cruise_fits(leg);
    requires value(leg->begin) <= value(steps) <= 0x7FFFFFFF0000000000000000;
    assigns \nothing;
    ensures value(leg->time) <= value(\result) && \result.high < 0xD000000000000000;
*/
static struct wide cruise_time(const struct path_leg *leg, struct wide steps);

/*@ requires \valid_read(leg) && cruise_fits(leg);
    requires value(leg->begin) <= value(steps) <= 0x7FFFFFFF0000000000000000;
    assigns \nothing;
    ensures value(leg->time) <= value(\result.time) && \result.time.high < 0xD000000000000000;
    ensures value(\result.place) == value(place) && \result.speed2 == leg->twice_speed2 / 2;
*/
static struct path_entry cruise_at(const struct path_leg *leg, struct wide place, struct wide steps);

/*@ requires \valid_read(leg) && cruise_fits(leg) && 1 <= grains_per_step;
    requires value(place) <= grains_per_step * 0x7FFFFFFF;
    requires value(leg->begin) * grains_per_step <= value(place) * 0x10000000000000000;
    assigns \nothing;
    ensures value(leg->time) <= value(\result.time) && \result.time.high < 0xD000000000000000;
    ensures value(\result.place) == value(place) && \result.speed2 == leg->twice_speed2 / 2;
*/
struct path_entry path_course_cruise_at(const struct path_leg *leg, struct wide place, uint64_t grains_per_step);

#endif
