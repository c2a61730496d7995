/*
 * The contract of path_course_last_pulse, proved with path_course_pulse.acsl.
 */
#ifndef COURSE_PULSES_H
#define COURSE_PULSES_H

#include "course_quotients.h"
#include "courses.h"

/*@ requires \valid_read(course) && course_fits(course);
    requires value(place) <= course_way(course) && steps <= course->length;
    assigns \nothing;
    ensures \result <= steps;
    ensures value(place) == course_way(course) ==> \result == steps;
    ensures quotient_of(value(place) * steps, course_way(course), \result);
*/
uint32_t path_course_last_pulse(const struct path_course *course, struct wide place, uint32_t steps);

#endif
