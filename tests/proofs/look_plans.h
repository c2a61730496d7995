/*
 * The contract of path_look in path_look.h, proved with path_look_entry.acsl.
 */
#ifndef LOOK_PLANS_H
#define LOOK_PLANS_H

#include "look_again.h"
#include "look_out.h"

/* A path that has been planned up to `looked`; where the plan begins, what look_out takes. Its sections have not been
 * counted once round since its origin. */
/*@ predicate begins_well(struct path *path) =
        begins_in(path, section_at(path, path->laid)) && path->next.speed2 <= 0x1000000000000000 &&
        path->origin.entry.speed2 <= 0x1000000000000000;
    predicate has_origin(struct path *path) =
        ahead(path->origin.section, path->laid) + path->size <= 0x100000000 &&
        (path->laid == path->origin.section ==> begins_well(path));
    predicate is_bounded(struct path *path, integer sections) =
        \forall integer k; 0 <= k < sections ==> known_at(path, k)->exit2 <= 0x1000000000000001;
    predicate is_planned(struct path *path, integer sections) =
        \forall integer k; 1 <= k < sections - 1 ==> is_backed(known_at(path, k), known_at(path, k + 1));
    predicate has_caps(struct path *path, integer sections) =
        \forall integer k; 0 <= k < sections - 1 ==> is_capped(known_at(path, k), known_at(path, k + 1));
    predicate has_looked(struct path *path) =
        knows(path, ahead(path->laid, path->known)) && has_origin(path) &&
        1 <= ahead(path->laid, path->looked) <= ahead(path->laid, path->known) &&
        known_at(path, 0)->exit2 <= 0x1000000000000001 &&
        (path->stopping ==> path->looked == path->known) &&
        (!path->stopping ==> is_bounded(path, ahead(path->laid, path->looked)) &&
            is_planned(path, ahead(path->laid, path->looked)) && has_caps(path, ahead(path->laid, path->looked)));
    logic integer grains(integer accel, integer length) = 2048 * accel * length;
    predicate same_numbers{A,B}(struct path_section *s) =
        \at(s->vector.speed, A) == \at(s->vector.speed, B) && \at(s->vector.accel, A) == \at(s->vector.accel, B) &&
        \at(s->vector.extent2, A) == \at(s->vector.extent2, B) && \at(s->length, A) == \at(s->length, B) &&
        grains(\at(s->vector.accel, A), \at(s->length, A)) == grains(\at(s->vector.accel, B), \at(s->length, B)) &&
        \at(s->plain, A) == \at(s->plain, B) && \at(s->gain2, A) == \at(s->gain2, B) &&
        \at(s->speed2, A) == \at(s->speed2, B);
    lemma fits_as_was{A,B}: \forall struct path_section *s; same_numbers{A,B}(s) && section_fits{A}(s) ==>
        section_fits{B}(s);
    lemma end_as_was{A,B}: \forall struct path_section *s; same_numbers{A,B}(s) ==>
        \at(end_of(s), A) == \at(end_of(s), B);
    predicate same_entry{A,B}(struct path *path) =
        \at(path->next.speed2, A) == \at(path->next.speed2, B) &&
        \at(path->next.place.high, A) == \at(path->next.place.high, B) &&
        \at(path->next.place.low, A) == \at(path->next.place.low, B) &&
        \at(path->origin.entry.speed2, A) == \at(path->origin.entry.speed2, B);
    lemma exit2_speed_apart: \forall struct path *path, integer i; is_path(path) && 0 <= i < path->size ==>
        &(path->ring + i)->exit2 != &path->next.speed2;
    lemma exit2_high_apart: \forall struct path *path, integer i; is_path(path) && 0 <= i < path->size ==>
        &(path->ring + i)->exit2 != &path->next.place.high;
    lemma exit2_low_apart: \forall struct path *path, integer i; is_path(path) && 0 <= i < path->size ==>
        &(path->ring + i)->exit2 != &path->next.place.low;
    lemma exit2_origin_apart: \forall struct path *path, integer i; is_path(path) && 0 <= i < path->size ==>
        &(path->ring + i)->exit2 != &path->origin.entry.speed2;
    lemma cap2_speed_apart: \forall struct path *path, integer i; is_path(path) && 0 <= i < path->size ==>
        &(path->ring + i)->cap2 != &path->next.speed2;
    lemma cap2_high_apart: \forall struct path *path, integer i; is_path(path) && 0 <= i < path->size ==>
        &(path->ring + i)->cap2 != &path->next.place.high;
    lemma cap2_low_apart: \forall struct path *path, integer i; is_path(path) && 0 <= i < path->size ==>
        &(path->ring + i)->cap2 != &path->next.place.low;
    lemma cap2_origin_apart: \forall struct path *path, integer i; is_path(path) && 0 <= i < path->size ==>
        &(path->ring + i)->cap2 != &path->origin.entry.speed2;
    predicate same_ring{A,B}(struct path *path) =
        \at(path->ring, A) == \at(path->ring, B) && \at(path->size, A) == \at(path->size, B) &&
        \at(path->laid, A) == \at(path->laid, B);
    lemma section_as_was{A,B}: \forall struct path *path, integer count; same_ring{A,B}(path) ==>
        \at(section_at(path, count), A) == \at(section_at(path, count), B);
    lemma known_as_was{A,B}: \forall struct path *path, integer k; same_ring{A,B}(path) ==>
        \at(known_at(path, k), A) == \at(known_at(path, k), B);
    lemma place_in_ring: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        0 <= place(path, k) < path->size;
    lemma ring_apart: \forall struct path *path, integer i; is_path(path) && 0 <= i < path->size ==>
        \separated(path, path->ring + i);
    lemma section_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        \separated(path, known_at(path, k));
    lemma looked_speed_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        &path->looked != &known_at(path, k)->vector.speed;
    lemma looked_accel_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        &path->looked != &known_at(path, k)->vector.accel;
    lemma looked_length_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        &path->looked != &known_at(path, k)->length;
    lemma next_extent2_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        &path->next.speed2 != &known_at(path, k)->vector.extent2;
    lemma next_gain2_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        &path->next.speed2 != &known_at(path, k)->gain2;
    lemma next_speed2_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        &path->next.speed2 != &known_at(path, k)->speed2;
    lemma next_border2_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        &path->next.speed2 != &known_at(path, k)->border2;
    lemma next_cap2_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        &path->next.speed2 != &known_at(path, k)->cap2;
    lemma next_exit2_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        &path->next.speed2 != &known_at(path, k)->exit2;
    lemma fast_plain_apart: \forall struct path *path, integer k; is_path(path) && 0 <= path->laid + k ==>
        &path->too_fast != &known_at(path, k)->plain;
*/

/*@ requires \valid(path) && knows(path, ahead(path->laid, path->known)) && has_origin(path);
    assigns path->looked, path->next.speed2, path->too_fast, path->ring[0 .. path->size - 1].exit2,
        path->ring[0 .. path->size - 1].cap2;
    ensures path->looked == path->known && has_looked(path);
*/
void path_look(struct path *path);

#endif
