/*
 * The sections of a path in the order in which they come, and the pulses of an axis in them: contracts of
 * path_change.c, proved with path_change_counts.acsl.
 */
#ifndef CHANGE_COUNTS_H
#define CHANGE_COUNTS_H

#include "looks.h"

/*@ logic integer after_first(struct path *path, integer count) =
        path->first <= count ? count - path->first : count - path->first + 0x100000000;
    logic struct path_section *counted_at(struct path *path, integer k) = section_at(path, path->first + k);
    logic integer steps_of(struct path_section *s, integer axis) =
        s->vector.steps[axis] < 0 ? -s->vector.steps[axis] : s->vector.steps[axis];
    predicate steps_fit(struct path_section *s) = s->length <= 0x7FFFFFFF && steps_of(s, 0) <= s->length &&
        steps_of(s, 1) <= s->length && steps_of(s, 2) <= s->length && steps_of(s, 3) <= s->length;
    predicate steps_within(struct path *path, integer sections) =
        \forall integer k; 0 <= k < sections ==> steps_fit(counted_at(path, k));
    predicate holds(struct path *path, integer sections) =
        is_path(path) && sections == after_first(path, path->end) && sections <= path->size &&
        steps_within(path, sections);
    lemma count_first: \forall struct path *path, integer count; 0 <= count < 0x100000000 ==>
        count == wrapped(path->first + after_first(path, count));
    lemma count_at: \forall struct path *path, integer count; is_path(path) && 0 <= count < 0x100000000 ==>
        section_at(path, count) == counted_at(path, after_first(path, count));
*/

/* The place of a change, and where the pulses of an axis have been handed over, among the sections of the ring. */
/*@ predicate place_in(struct path *path, struct path_place *place) =
        after_first(path, place->section) < after_first(path, path->end);
    predicate cursor_in(struct path *path, integer axis) =
        after_first(path, path->axis[axis].section) <= after_first(path, path->end) && 1 <= path->axis[axis].pulse;
*/

/* Pulses of an axis before a place, `there` of them in its section, and whether all have been handed over. */
/*@ predicate none_between(struct path *path, integer axis, integer from, integer to) =
        \forall integer k; from <= k < to ==> steps_of(counted_at(path, k), axis) == 0;
    predicate handed_over(struct path *path, struct path_place *place, integer axis, integer there) =
        after_first(path, place->section) < after_first(path, path->axis[axis].section) ||
        (place->section == path->axis[axis].section && there <= path->axis[axis].pulse - 1) ||
        (after_first(path, path->axis[axis].section) < after_first(path, place->section) && there == 0 &&
            steps_of(section_at(path, path->axis[axis].section), axis) <= path->axis[axis].pulse - 1 &&
            none_between(path, axis, after_first(path, path->axis[axis].section) + 1,
                after_first(path, place->section)));
    logic integer steps_between(struct path *path, integer axis, integer from, integer to) =
        to <= from ? 0 : steps_between(path, axis, from, to - 1) + steps_of(counted_at(path, to - 1), axis);
    logic integer void_after(struct path *path, struct path_place *place, integer axis, integer there) =
        after_first(path, path->axis[axis].section) < after_first(path, place->section) ? 0 :
            path->axis[axis].pulse - 1 - there + steps_between(path, axis, after_first(path, place->section),
                after_first(path, path->axis[axis].section));
*/

/*@ requires \valid_read(path);
    assigns \nothing;
    ensures \result <==> after_first(path, a) < after_first(path, b);
*/
static bool is_before(const struct path *path, uint32_t a, uint32_t b);

/*@ requires holds(path, after_first(path, path->end)) && \valid_read(place) && place_in(path, place);
    requires axis < PATH_AXES && cursor_in(path, axis);
    assigns \nothing;
    ensures \result <==> handed_over(path, place, axis, there);
*/
static bool is_handed_over(const struct path *path, const struct path_place *place, unsigned axis, uint32_t there);

/*@ requires holds(path, after_first(path, path->end)) && \valid_read(place) && place_in(path, place);
    requires axis < PATH_AXES && cursor_in(path, axis);
    requires handed_over(path, place, axis, there) && there <= steps_of(section_at(path, place->section), axis);
    assigns \nothing;
    ensures \result == void_after(path, place, axis, there) && \result < 0x8000000000000000;
*/
static uint64_t count_void(const struct path *path, const struct path_place *place, unsigned axis, uint32_t there);

#endif
