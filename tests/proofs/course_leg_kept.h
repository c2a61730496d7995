/*
 * What keeps a leg, and what its course keeps of its vector, keeps what is asked of the leg.
 */
#ifndef COURSE_LEG_KEPT_H
#define COURSE_LEG_KEPT_H

#include "course_entered.h"
#include "course_legs.h"

/*@ predicate sizes_kept{A,B}(struct path_course *c) = length_kept{A,B}(c) && grains_kept{A,B}(c);
    predicate vector_kept{A,B}(struct path_course *c) =
        sizes_kept{A,B}(c) && whole_kept{A,B}(c) && divisor_kept{A,B}(c);
    predicate ramps_kept{A,B}(struct path_course *c) = \at(ramps_ready(c), A) ==> \at(ramps_ready(c), B);
    predicate leg_kept{A,B}(struct path_leg *l) = \at(*l, A) == \at(*l, B);
    predicate leg_bound(struct path_leg *l) =
        -PATH_ACCEL_MAX <= l->accel <= PATH_ACCEL_MAX && l->slope.high <= 0x70000000000000 &&
        l->time.high <= 0x8000000000000000 && l->twice_speed2 <= twice_speed2_most;
    predicate leg_in(struct path_course *c, struct path_leg *l) = leg_asked(c, l) && leg_bound(l);
*/

/* By steps, and what is a product as one. */
/*@ predicate lies_in(struct path_course *c, struct path_leg *l) =
        value(l->place) <= value(l->end) <= course_way(c);
    predicate begins_in(struct path_course *c, struct path_leg *l) =
        value(l->begin) * c->grains_per_step <= value(l->place) * 0x10000000000000000;
    predicate ramp_asked(struct path_course *c, struct path_leg *l) =
        l->accel != 0 ==> ramp_squares(l) && ramps_ready(c);
    predicate cruise_asked(struct path_course *c, struct path_leg *l) =
        l->accel == 0 ==> cruise_fits(l) && begins_in(c, l);
    predicate same_begin{A,B}(struct path_course *c, struct path_leg *l) =
        equal_two(\at(value(l->begin), A), \at(c->grains_per_step, A), \at(value(l->begin), B),
            \at(c->grains_per_step, B));
    lemma leg_parts: \forall struct path_course *c, struct path_leg *l; leg_in(c, l) ==>
        lies_in(c, l) && ramp_asked(c, l) && cruise_asked(c, l) && leg_bound(l);
    lemma leg_of_parts: \forall struct path_course *c, struct path_leg *l;
        lies_in(c, l) && ramp_asked(c, l) && cruise_asked(c, l) && leg_bound(l) ==> leg_in(c, l);
    lemma sizes_same{A,B}: \forall struct path_course *c; sizes_kept{A,B}(c) ==> same_sizes{A,B}(c);
    lemma vector_fits_kept{A,B}: \forall struct path_course *c; vector_kept{A,B}(c) && \at(course_fits(c), A) ==>
        \at(course_fits(c), B);
    lemma begin_same{A,B}: \forall struct path_course *c, struct path_leg *l;
        sizes_kept{A,B}(c) && leg_kept{A,B}(l) ==> same_begin{A,B}(c, l);
    lemma lies_kept{A,B}: \forall struct path_course *c, struct path_leg *l;
        sizes_kept{A,B}(c) && leg_kept{A,B}(l) && \at(lies_in(c, l), A) ==> \at(lies_in(c, l), B);
    lemma begins_kept{A,B}: \forall struct path_course *c, struct path_leg *l;
        same_begin{A,B}(c, l) && leg_kept{A,B}(l) && \at(begins_in(c, l), A) ==> \at(begins_in(c, l), B);
    lemma ramp_asked_kept{A,B}: \forall struct path_course *c, struct path_leg *l;
        ramps_kept{A,B}(c) && leg_kept{A,B}(l) && \at(ramp_asked(c, l), A) ==> \at(ramp_asked(c, l), B);
    lemma cruise_fits_kept{A,B}: \forall struct path_leg *l;
        leg_kept{A,B}(l) && \at(cruise_fits(l), A) ==> \at(cruise_fits(l), B);
    lemma cruise_asked_kept{A,B}: \forall struct path_course *c, struct path_leg *l;
        sizes_kept{A,B}(c) && leg_kept{A,B}(l) && \at(cruise_asked(c, l), A) ==> \at(cruise_asked(c, l), B);
    lemma bound_kept{A,B}: \forall struct path_leg *l;
        leg_kept{A,B}(l) && \at(leg_bound(l), A) ==> \at(leg_bound(l), B);
    lemma leg_in_kept{A,B}: \forall struct path_course *c, struct path_leg *l;
        sizes_kept{A,B}(c) && ramps_kept{A,B}(c) && leg_kept{A,B}(l) && \at(leg_in(c, l), A) ==>
        \at(leg_in(c, l), B);
*/

/* The legs of a course. */
/*@ predicate third_kept{A,B}(struct path_course *c) = \at(c->leg[2], A) == \at(c->leg[2], B);
    lemma first_leg{A,B}: \forall struct path_course *c; first_kept{A,B}(c) ==> leg_kept{A,B}(\at(&c->leg[0], B));
    lemma second_leg{A,B}: \forall struct path_course *c; second_kept{A,B}(c) ==> leg_kept{A,B}(\at(&c->leg[1], B));
    lemma third_leg{A,B}: \forall struct path_course *c; third_kept{A,B}(c) ==> leg_kept{A,B}(\at(&c->leg[2], B));
    lemma first_kept{A,B}: \forall struct path_course *c;
        sizes_kept{A,B}(c) && ramps_kept{A,B}(c) && first_kept{A,B}(c) && \at(leg_in(c, &c->leg[0]), A) ==>
        \at(leg_in(c, &c->leg[0]), B);
    lemma second_kept{A,B}: \forall struct path_course *c;
        sizes_kept{A,B}(c) && ramps_kept{A,B}(c) && second_kept{A,B}(c) && \at(leg_in(c, &c->leg[1]), A) ==>
        \at(leg_in(c, &c->leg[1]), B);
    lemma third_kept{A,B}: \forall struct path_course *c;
        sizes_kept{A,B}(c) && ramps_kept{A,B}(c) && third_kept{A,B}(c) && \at(leg_in(c, &c->leg[2]), A) ==>
        \at(leg_in(c, &c->leg[2]), B);
*/

/* Where legs begin and end. */
/*@ predicate begins_at(struct path_leg *l, integer place) = value(l->place) == place;
    predicate ends_at(struct path_leg *l, integer place) = value(l->end) == place;
    predicate starts(struct path_leg *l, integer place, integer time) =
        value(l->place) == place && value(l->time) == time;
    predicate joins_first(struct path_course *c) = value(c->leg[1].place) == value(c->leg[0].end);
    predicate joins_second(struct path_course *c) = value(c->leg[2].place) == value(c->leg[1].end);
    lemma first_ends{A,B}: \forall struct path_course *c, integer place;
        first_kept{A,B}(c) && \at(ends_at(&c->leg[0], place), A) ==> \at(ends_at(&c->leg[0], place), B);
    lemma second_ends{A,B}: \forall struct path_course *c, integer place;
        second_kept{A,B}(c) && \at(ends_at(&c->leg[1], place), A) ==> \at(ends_at(&c->leg[1], place), B);
    lemma third_ends{A,B}: \forall struct path_course *c, integer place;
        third_kept{A,B}(c) && \at(ends_at(&c->leg[2], place), A) ==> \at(ends_at(&c->leg[2], place), B);
    lemma first_starts{A,B}: \forall struct path_course *c, integer place, time;
        first_kept{A,B}(c) && \at(starts(&c->leg[0], place, time), A) ==> \at(starts(&c->leg[0], place, time), B);
    lemma first_joins{A,B}: \forall struct path_course *c;
        first_kept{A,B}(c) && second_kept{A,B}(c) && \at(joins_first(c), A) ==> \at(joins_first(c), B);
    lemma second_joins{A,B}: \forall struct path_course *c;
        second_kept{A,B}(c) && third_kept{A,B}(c) && \at(joins_second(c), A) ==> \at(joins_second(c), B);
*/

/* Legs that are laid, from a place and a time on, up to a place. */
/*@ predicate in_first(struct path_course *c) = 1 <= c->legs ==> leg_in(c, &c->leg[0]);
    predicate in_second(struct path_course *c) =
        2 <= c->legs ==> leg_in(c, &c->leg[1]) && joins_first(c);
    predicate in_third(struct path_course *c) =
        3 <= c->legs ==> leg_in(c, &c->leg[2]) && joins_second(c);
    predicate laid_from(struct path_course *c, integer place, integer time, integer begin, integer since) =
        c->legs == 0 ? place == begin && time == since : starts(&c->leg[0], begin, since);
    predicate laid_until(struct path_course *c, integer place) =
        (c->legs == 1 ==> ends_at(&c->leg[0], place)) && (c->legs == 2 ==> ends_at(&c->leg[1], place)) &&
        (c->legs == 3 ==> ends_at(&c->leg[2], place));
*/

#endif
