/*
 * The contract of a whole step of a course in path_course.h, proved with path_course_step.acsl.
 */
#ifndef COURSE_STEPS_H
#define COURSE_STEPS_H

#include "course_legs.h"
#include "course_places.h"

/*@ requires \valid_read(course) && legs_asked(course) && 1 <= course->legs;
    requires step * course->grains_per_step <= value(course->leg[course->legs - 1].end);
    assigns \nothing;
    ensures 2 * \result.speed2 <= twice_speed2_most && \result.time.high < 0xD000000000000000;
    ensures value(\result.place) == step * course->grains_per_step ||
        (step * course->grains_per_step < value(course->leg[0].place) &&
            value(\result.place) == value(course->leg[0].place));
*/
struct path_entry path_course_step(const struct path_course *course, uint64_t step);

#endif
