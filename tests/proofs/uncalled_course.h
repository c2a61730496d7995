/*
 * Parts of a path's course that are not asked in what is proved.
 */
#ifndef UNCALLED_COURSE_H
#define UNCALLED_COURSE_H

#include "path_course.h"

/*@ requires \false;
    assigns \nothing;
*/
struct path_pulse path_course_pulse(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                    uint32_t pulse);

/*@ requires \false;
    assigns \nothing;
*/
struct path_entry path_course_step(const struct path_course *course, uint64_t step);

#endif
