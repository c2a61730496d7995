/*
 * Whether a path can rest with an acceleration of its own: the contract of path_can_rest in path.h, proved with
 * path_change_rests.acsl.
 */
#ifndef CHANGE_RESTS_H
#define CHANGE_RESTS_H

#include "change_sections.h"
#include "lays.h"

/* What is left of the way, and of those sections which count another length or brake faster. */
/*@ logic integer lengths_from(struct path *path, integer from, integer sections) =
        sections <= 0 ? 0 : lengths_from(path, from, sections - 1) + next_at(path, from, sections - 1)->length;
    predicate plain_from(struct path *path, integer from, integer sections) =
        \forall integer k; 0 <= k < sections ==> next_at(path, from, k)->plain;
    predicate slower_from(struct path *path, integer from, integer sections, integer accel) =
        \forall integer k; 0 <= k < sections ==> next_at(path, from, k)->vector.accel <= accel;
    predicate steps_left(integer lengths, integer place, integer grains, integer steps) =
        steps * grains <= lengths * grains - place < steps * grains + grains;
    predicate can_rest(struct path *path, struct path_place *place, integer sections, integer steps) =
        (plain_from(path, place->section, sections) ||
            slower_from(path, place->section, sections, place->accel)) &&
        place->entry.speed2 <= 1024 * place->accel * steps + square(path->start_speed);
*/

/*@ requires is_path(path) && \valid_read(place) && 1 <= place->accel <= PATH_ACCEL_MAX;
    requires fit_from(path, place->section, sections_from(place->section, plan_end(path)));
    requires value(place->entry.place) <=
        grains_of(section_at(path, place->section), place) * section_at(path, place->section)->length;
    assigns \nothing;
    ensures \exists integer steps; steps_left(
            lengths_from(path, place->section, sections_from(place->section, plan_end(path))),
            value(place->entry.place), grains_of(section_at(path, place->section), place), steps) &&
        (\result <==> can_rest(path, place, sections_from(place->section, plan_end(path)), steps));
*/
bool path_can_rest(const struct path *path, const struct path_place *place);

#endif
