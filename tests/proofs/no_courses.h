/*
 * Contracts of path_course.h for what does not ask for a place of a course.
 */
#ifndef NO_COURSES_H
#define NO_COURSES_H

#include "path_course.h"

/*@ requires \false;
    assigns \nothing;
*/
struct path_entry path_course_at(const struct path_course *course, const struct path_leg *leg, struct wide place);

/*@ requires \false;
    assigns \nothing;
*/
struct path_entry path_course_cruise_at(const struct path_leg *leg, struct wide place, uint64_t grains_per_step);

/*@ requires \false;
    assigns \nothing;
*/
struct path_entry path_course_step(const struct path_course *course, uint64_t step);

#endif
