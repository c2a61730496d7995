/*
 * The sections of a ring that a path has not laid, counted from the first of them, and the contract of look_backward in
 * path_look.c, proved with path_look_backward.acsl.
 */
#ifndef LOOK_RINGS_H
#define LOOK_RINGS_H

#include "looks.h"

/*@ logic integer ahead(integer from, integer to) = from <= to ? to - from : to - from + 0x100000000;
    lemma ahead_wrapped: \forall integer from, to; 0 <= from < 0x100000000 && 0 <= to < 0x100000000 ==>
        to == wrapped(from + ahead(from, to));
    logic struct path_section *known_at(struct path *path, integer i) = section_at(path, path->laid + i);
    logic integer place(struct path *path, integer i) = (path->laid + i) % path->size;
    lemma places_apart: \forall struct path *path, integer i, k; is_path(path) && 0 <= i < k < i + path->size ==>
        apart(path->size, path->laid + i, path->laid + k);
    lemma places_differ: \forall struct path *path, integer i, k; is_path(path) && 0 <= i < k < i + path->size ==>
        place(path, i) != place(path, k);
    lemma known_place: \forall struct path *path, integer i; known_at(path, i) == path->ring + place(path, i);
    lemma cap_extent_apart: \forall struct path *path, integer i, k;
        &known_at(path, i)->cap2 != &known_at(path, k)->vector.extent2;
    lemma cap_gain_apart: \forall struct path *path, integer i, k;
        &known_at(path, i)->cap2 != &known_at(path, k)->gain2;
    lemma cap_speed_apart: \forall struct path *path, integer i, k;
        &known_at(path, i)->cap2 != &known_at(path, k)->speed2;
    lemma cap_border_apart: \forall struct path *path, integer i, k;
        &known_at(path, i)->cap2 != &known_at(path, k)->border2;
    lemma cap_other_apart: \forall struct path *path, integer i, k;
        &known_at(path, i)->cap2 != &known_at(path, k)->exit2;
    lemma exit_extent_apart: \forall struct path *path, integer i, k;
        &known_at(path, i)->exit2 != &known_at(path, k)->vector.extent2;
    lemma exit_gain_apart: \forall struct path *path, integer i, k;
        &known_at(path, i)->exit2 != &known_at(path, k)->gain2;
    lemma exit_speed_apart: \forall struct path *path, integer i, k;
        &known_at(path, i)->exit2 != &known_at(path, k)->speed2;
    lemma exit_border_apart: \forall struct path *path, integer i, k;
        &known_at(path, i)->exit2 != &known_at(path, k)->border2;
    lemma caps_apart: \forall struct path *path, integer i, k; place(path, i) != place(path, k) ==>
        &known_at(path, i)->cap2 != &known_at(path, k)->cap2;
    lemma exits_apart: \forall struct path *path, integer i, k; place(path, i) != place(path, k) ==>
        &known_at(path, i)->exit2 != &known_at(path, k)->exit2;
    predicate knows(struct path *path, integer sections) =
        is_path(path) && sections == ahead(path->laid, path->known) && 1 <= sections <= path->size &&
        \forall integer k; 0 <= k < sections ==> section_fits(known_at(path, k));
    predicate is_capped(struct path_section *before, struct path_section *after) =
        after->cap2 == lower_of(lower_of(after->speed2, after->border2), before->speed2);
    predicate is_backed(struct path_section *before, struct path_section *after) =
        is_capped(before, after) && before->exit2 == lower_of(after->cap2, after->exit2 + after->gain2);
*/

/*@ requires knows(path, ahead(path->laid, path->known));
    requires ahead(path->laid, until) < ahead(path->laid, path->known);
    assigns path->ring[0 .. path->size - 1].exit2, path->ring[0 .. path->size - 1].cap2;
    ensures \forall integer k; ahead(path->laid, until) <= k < ahead(path->laid, path->known) - 1 ==>
        is_backed(known_at(path, k), known_at(path, k + 1));
    ensures \forall integer k; ahead(path->laid, until) <= k < ahead(path->laid, path->known) ==>
        known_at(path, k)->exit2 <= known_at(path, k)->speed2;
    ensures \forall integer k; 0 <= k < ahead(path->laid, until) ==>
        known_at(path, k)->exit2 == \old(known_at(path, \at(k, Here))->exit2);
    ensures \forall integer k; 0 <= k <= ahead(path->laid, until) ==>
        known_at(path, k)->cap2 == \old(known_at(path, \at(k, Here))->cap2);
    ensures knows(path, ahead(path->laid, path->known));
*/
static void look_backward(const struct path *path, uint32_t until);

#endif
