/*
 * Contracts of places of a course in path_course.h, proved with path_course_at.acsl.
 */
#ifndef COURSE_PLACES_H
#define COURSE_PLACES_H

#include "course_cruises.h"
#include "course_ramp_pulses.h"
#include "courses.h"

/*@ requires \valid_read(course) && course_fits(course) && \valid_read(leg);
    requires value(leg->place) <= value(place) <= value(leg->end) <= course_way(course);
    requires leg->accel != 0 ==> ramp_squares(leg) && is_ready(course->per_accel) && 2 <= number(course->per_accel);
    requires leg->accel == 0 ==> cruise_fits(leg) &&
        value(leg->begin) * course->grains_per_step <= value(place) * 0x10000000000000000;
    assigns \nothing;
    ensures value(leg->time) <= value(\result.time) && \result.time.high < 0xD000000000000000;
    ensures value(\result.place) == value(place) && 2 * \result.speed2 <= twice_speed2_most;
    ensures leg->accel == 0 ==> \result.speed2 == leg->twice_speed2 / 2;
    ensures 0 < leg->accel ==> \result.speed2 == (leg->twice_speed2 + value(place) - value(leg->place)) / 2;
    ensures leg->accel < 0 ==> \result.speed2 == (leg->twice_speed2 - value(place) + value(leg->place)) / 2;
*/
struct path_entry path_course_at(const struct path_course *course, const struct path_leg *leg, struct wide place);

#endif
