/*
 * The place of a change at a border: the contract of pass_border in path_change.c, proved with path_change_border.acsl.
 */
#ifndef CHANGE_PLACES_H
#define CHANGE_PLACES_H

#include "lays.h"

/* The count after the last section that a place may be in, and what a place at the end of its section goes on to. */
/*@ logic integer last_place(struct path *path) = path->start_speed == 0 ? path->end : path->known;
    predicate is_at_end(struct path *path, struct path_place *place) =
        grains_of(section_at(path, place->section), place) * section_at(path, place->section)->length <=
            value(place->entry.place);
    predicate goes_on(struct path *path, struct path_place *place) =
        wrapped(place->section + 1) != last_place(path);
*/

/*@ requires is_path(path) && \valid(place) && \separated(place, path, path->ring + (0 .. path->size - 1));
    requires section_fits(section_at(path, place->section)) && place->accel <= PATH_ACCEL_MAX;
    requires is_at_end(path, place) && goes_on(path, place) ==>
        section_fits(section_at(path, wrapped(place->section + 1)));
    assigns place->section, place->entry.place, place->entry.speed2;
    ensures \result <==> !\old(is_at_end(path, place)) || \old(goes_on(path, place));
    ensures !\old(is_at_end(path, place)) ==> place->section == \old(place->section) &&
        value(place->entry.place) == \old(value(place->entry.place)) &&
        place->entry.speed2 == \old(place->entry.speed2);
    ensures \old(is_at_end(path, place)) ==> place->section == wrapped(\old(place->section) + 1);
    ensures \old(is_at_end(path, place)) && \result ==> value(place->entry.place) == 0;
*/
static bool pass_border(const struct path *path, struct path_place *place);

#endif
