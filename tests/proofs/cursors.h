/*
 * Cursors of a path's axes, on the course of the section in which they stand.
 */
#ifndef CURSORS_H
#define CURSORS_H

#include "equals.h"

#include "course_pulses.h"

#include "path.h"

/* A course whose legs join, and a cursor that is on one of them, or before it; or has passed all. */
/*@ logic integer end_of_leg(struct path_course *c, integer leg) = value(c->leg[leg].end);
    logic integer place_of_leg(struct path_course *c, integer leg) = value(c->leg[leg].place);
    predicate legs_join(struct path_course *c) =
        course_fits(c) && c->legs <= 3 && (1 <= c->legs ==> end_of_leg(c, 0) <= course_way(c)) &&
        (2 <= c->legs ==> end_of_leg(c, 1) <= course_way(c) && place_of_leg(c, 1) == end_of_leg(c, 0)) &&
        (3 <= c->legs ==> end_of_leg(c, 2) <= course_way(c) && place_of_leg(c, 2) == end_of_leg(c, 1));
    predicate joins(struct path_course *c, integer leg) =
        leg + 1 < c->legs ==> place_of_leg(c, leg + 1) == end_of_leg(c, leg);
    lemma joins: \forall struct path_course *c, integer leg; legs_join(c) && 0 <= leg ==> joins(c, leg);
    predicate is_beyond(integer place, integer way, integer steps, integer pulse) = place * steps <= pulse * way;
    predicate is_last(integer end, integer way, integer steps, integer last) =
        0 <= last <= steps && quotient_of(end * steps, way, last);
    predicate cursor_fits(struct path_cursor *cursor, struct path_course *c, integer steps) =
        cursor->leg <= c->legs &&
        (cursor->leg < c->legs ==>
            is_beyond(place_of_leg(c, cursor->leg), course_way(c), steps, cursor->pulse)) &&
        (cursor->leg < c->legs && cursor->entered ==>
            is_last(end_of_leg(c, cursor->leg), course_way(c), steps, cursor->last));
    predicate passes(integer end, integer way, integer steps, integer last, integer pulse) =
        is_last(end, way, steps, last) && last + 1 <= pulse;
    lemma passes_ordered: \forall integer end, way, steps, last, pulse; passes(end, way, steps, last, pulse) ==>
        ordered_by(last + 1, pulse, way);
    lemma passes: \forall integer end, way, steps, last, pulse; passes(end, way, steps, last, pulse) ==>
        is_beyond(end, way, steps, pulse);
    predicate course_same{A,B}(struct path_course *c) =
        \at(c->legs, A) == \at(c->legs, B) && \at(c->length, A) == \at(c->length, B) &&
        \at(c->grains_per_step, A) == \at(c->grains_per_step, B) &&
        \at(c->whole.high, A) == \at(c->whole.high, B) && \at(c->whole.low, A) == \at(c->whole.low, B) &&
        \at(c->per_length.scaled, A) == \at(c->per_length.scaled, B) &&
        \at(c->per_length.reciprocal, A) == \at(c->per_length.reciprocal, B) &&
        \at(c->per_length.shift, A) == \at(c->per_length.shift, B) &&
        \at(end_of_leg(c, 0), A) == \at(end_of_leg(c, 0), B) && \at(end_of_leg(c, 1), A) == \at(end_of_leg(c, 1), B) &&
        \at(end_of_leg(c, 2), A) == \at(end_of_leg(c, 2), B) &&
        \at(place_of_leg(c, 1), A) == \at(place_of_leg(c, 1), B) &&
        \at(place_of_leg(c, 2), A) == \at(place_of_leg(c, 2), B);
    lemma way_parts{A,B}: \forall struct path_course *c; course_same{A,B}(c) ==>
        equal_two(\at(c->grains_per_step, A), \at(c->length, A), \at(c->grains_per_step, B), \at(c->length, B));
    lemma way_same{A,B}: \forall struct path_course *c; course_same{A,B}(c) ==>
        \at(course_way(c), A) == \at(course_way(c), B);
    lemma whole_same{A,B}: \forall struct path_course *c; course_same{A,B}(c) ==>
        \at(value(c->whole), A) == \at(value(c->whole), B);
    lemma divisor_same{A,B}: \forall struct path_course *c; course_same{A,B}(c) ==>
        \at(c->per_length, A) == \at(c->per_length, B);
    lemma fits_same{A,B}: \forall struct path_course *c; course_same{A,B}(c) && \at(course_fits(c), A) ==>
        \at(course_fits(c), B);
    lemma legs_same{A,B}: \forall struct path_course *c; course_same{A,B}(c) && \at(legs_join(c), A) ==>
        \at(legs_join(c), B);
*/

#endif
