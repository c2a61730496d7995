/*
 * What the laying of a leg leaves of its course as it was.
 */
#ifndef COURSE_KEPT_H
#define COURSE_KEPT_H

#include "courses.h"

/*@ predicate length_kept{A,B}(struct path_course *c) = \at(c->length, A) == \at(c->length, B);
    predicate grains_kept{A,B}(struct path_course *c) = \at(c->grains_per_step, A) == \at(c->grains_per_step, B);
    predicate whole_kept{A,B}(struct path_course *c) = \at(c->whole, A) == \at(c->whole, B);
    predicate end_kept{A,B}(struct path_course *c) = \at(c->end, A) == \at(c->end, B);
    predicate divisor_kept{A,B}(struct path_course *c) = \at(c->per_length, A) == \at(c->per_length, B);
    predicate accel_kept{A,B}(struct path_course *c) = \at(c->per_accel, A) == \at(c->per_accel, B);
    predicate course_kept{A,B}(struct path_course *c) = length_kept{A,B}(c) && grains_kept{A,B}(c) &&
        whole_kept{A,B}(c) && end_kept{A,B}(c) && divisor_kept{A,B}(c);
    predicate first_kept{A,B}(struct path_course *c) = \at(c->leg[0], A) == \at(c->leg[0], B);
    predicate second_kept{A,B}(struct path_course *c) = \at(c->leg[1], A) == \at(c->leg[1], B);
*/

/* Members and legs of a course, apart from what is written with a leg. */
/*@ predicate leg_off(struct path_leg *a, struct path_leg *l) = \separated(a, l) && \separated(a, &l->begin) &&
        \separated(a, &l->pace) && \separated(a, &l->end) && \separated(a, &l->accel);
    predicate member_off(struct wide *w, struct path_leg *l) = \separated(w, l) && \separated(w, &l->begin) &&
        \separated(w, &l->pace) && \separated(w, &l->end);
    predicate divisor_off(struct path_divisor *d, struct path_leg *l) = \separated(d, l) &&
        \separated(d, &l->begin) && \separated(d, &l->pace) && \separated(d, &l->end);
    predicate cell_off(uint64_t *cell, struct path_leg *l) = \separated(cell, l) && \separated(cell, &l->begin) &&
        \separated(cell, &l->pace) && \separated(cell, &l->end);
*/

#endif
