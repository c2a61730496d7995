/*
 * How a course is laid, which is not asked in what is proved.
 */
#ifndef UNCALLED_COURSE_LAY_H
#define UNCALLED_COURSE_LAY_H

#include "path_course.h"

/*@ requires \false;
    assigns \nothing;
*/
void path_course_lay(struct path_course *course, const struct path_section *section, const struct path_entry *entry,
                     const struct path_goal *goal, struct path_speeds *speeds);

#endif
