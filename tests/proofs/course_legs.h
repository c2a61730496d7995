/*
 * Legs of a course: what the functions of path_course.c that read them ask for, and path_course_lay leaves.
 */
#ifndef COURSE_LEGS_H
#define COURSE_LEGS_H

#include "course_cruises.h"
#include "course_ramp_pulses.h"

/*@ predicate ramps_ready(struct path_course *c) = is_ready(c->per_accel) && 2 <= number(c->per_accel);
    predicate leg_asked(struct path_course *c, struct path_leg *l) =
        value(l->place) <= value(l->end) <= course_way(c) &&
        (l->accel != 0 ==> ramp_squares(l) && ramps_ready(c)) &&
        (l->accel == 0 ==> cruise_fits(l) &&
            value(l->begin) * c->grains_per_step <= value(l->place) * 0x10000000000000000);
    predicate legs_asked(struct path_course *c) =
        course_fits(c) && c->legs <= 3 && (1 <= c->legs ==> leg_asked(c, &c->leg[0])) &&
        (2 <= c->legs ==> leg_asked(c, &c->leg[1]) && value(c->leg[1].place) == value(c->leg[0].end)) &&
        (3 <= c->legs ==> leg_asked(c, &c->leg[2]) && value(c->leg[2].place) == value(c->leg[1].end));
*/

#endif
