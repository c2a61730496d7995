/*
 * What is read while a course is laid stays as it is: the section, its entry, and what the course keeps of them.
 */
#ifndef COURSE_ENTERED_H
#define COURSE_ENTERED_H

#include "course_kept.h"
#include "equals.h"

/* The way of a course is a product: said by steps, so that no prover multiplies. */
/*@ predicate same_sizes{A,B}(struct path_course *c) =
        equal_two(\at(c->grains_per_step, A), \at(c->length, A), \at(c->grains_per_step, B), \at(c->length, B));
    predicate same_way{A,B}(struct path_course *c) = \at(course_way(c), A) == \at(course_way(c), B);
    predicate goes(struct path_course *c, integer way) = course_way(c) == way && value(c->end) == way;
    lemma same_sizes{A,B}: \forall struct path_course *c; course_kept{A,B}(c) ==> same_sizes{A,B}(c);
    lemma same_way{A,B}: \forall struct path_course *c; same_sizes{A,B}(c) ==> same_way{A,B}(c);
    lemma goes_kept{A,B}: \forall struct path_course *c, integer way; course_kept{A,B}(c) && \at(goes(c, way), A) ==>
        \at(goes(c, way), B);
    lemma fits_kept{A,B}: \forall struct path_course *c; course_kept{A,B}(c) && \at(course_fits(c), A) ==>
        \at(course_fits(c), B);
*/

/*@ predicate sized(struct path_course *c, integer length, integer grains) =
        c->length == length && c->grains_per_step == grains;
    lemma sized_kept{A,B}: \forall struct path_course *c, integer length, grains;
        course_kept{A,B}(c) && \at(sized(c, length, grains), A) ==> \at(sized(c, length, grains), B);
    predicate steps_kept{A,B}(struct path_section *s) = \at(s->length, A) == \at(s->length, B);
    predicate pull_kept{A,B}(struct path_section *s) = \at(s->vector.accel, A) == \at(s->vector.accel, B);
    predicate section_kept{A,B}(struct path_section *s) = steps_kept{A,B}(s) && pull_kept{A,B}(s);
    predicate place_kept{A,B}(struct path_entry *e) = \at(e->place, A) == \at(e->place, B);
    predicate since_kept{A,B}(struct path_entry *e) = \at(e->time, A) == \at(e->time, B);
    predicate entry_kept{A,B}(struct path_entry *e) = place_kept{A,B}(e) && since_kept{A,B}(e);
    predicate holds(uint64_t *cell, integer x) = *cell == x;
    predicate holds_32(uint32_t *cell, integer x) = *cell == x;
*/

#endif
