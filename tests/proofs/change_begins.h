/*
 * What a plan asks of the place that it begins at: a contract of path_lay.h.
 */
#ifndef CHANGE_BEGINS_H
#define CHANGE_BEGINS_H

#include "change_sections.h"
#include "lays.h"

/*@ predicate begins_at(struct path *path, struct path_place *place) =
        fit_from(path, place->section, sections_from(place->section, plan_end(path))) &&
        place_fits(section_at(path, place->section), place) &&
        value(place->entry.place) <= end_of(section_at(path, place->section)) &&
        place->entry.speed2 <= 0x1000000000000000;
*/

/*@ requires is_path(path) && \valid(path) && \valid_read(place);
    requires \separated(place, path, path->ring + (0 .. path->size - 1));
    requires begins_at(path, place);
    assigns *path, path->ring[0 .. path->size - 1].exit2, path->ring[0 .. path->size - 1].cap2;
*/
void path_lay_begin(struct path *path, const struct path_place *place);

#endif
