/*
 * Another acceleration for all sections from a place on: the contract of set_accel in path_change.c, proved with
 * path_change_accels.acsl.
 */
#ifndef CHANGE_ACCELS_H
#define CHANGE_ACCELS_H

#include "change_sections.h"

/*@ predicate axes_within(struct path_section *s) =
        \forall integer axis; 0 <= axis < PATH_AXES ==> -s->length <= s->vector.steps[axis] <= s->length;
    predicate is_set(struct path_section *s) = section_fits(s) && axes_within(s);
    predicate set_from(struct path *path, integer from, integer sections) =
        1 <= sections <= path->size && \forall integer k; 0 <= k < sections ==> is_set(next_at(path, from, k));
*/

/*@ requires is_path(path) && \valid_read(place) && \separated(place, path->ring + (0 .. path->size - 1));
    requires 1 <= place->accel <= PATH_ACCEL_MAX && 1 <= path->turn_us <= PATH_TURN_US_MAX;
    requires set_from(path, place->section, sections_from(place->section, path->end));
    assigns path->ring[0 .. path->size - 1].vector.accel, path->ring[0 .. path->size - 1].gain2,
        path->ring[0 .. path->size - 1].border2, path->ring[0 .. path->size - 1].turning;
    ensures set_from(path, place->section, sections_from(place->section, path->end));
    ensures \forall integer i; 0 <= i < path->size ==> path->ring[i].length == \old(path->ring[\at(i, Here)].length);
*/
static void set_accel(const struct path *path, const struct path_place *place);

#endif
