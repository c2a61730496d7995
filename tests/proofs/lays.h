/*
 * Laying a path: contracts of path_lay.h and path_lay.c, proved with path_lay.acsl.
 */
#ifndef LAYS_H
#define LAYS_H

#include "course_quotients.h"
#include "looks.h"
#include "path_quotients.h"
#include "path_roots.h"
#include "path_speeds.h"

#include "path_lay.h"

/*@ logic integer grains_of(struct path_section *s, struct path_place *place) =
        place->accel != 0 ? 2048 * place->accel : 2048 * s->vector.accel;
*/

/*@ requires is_path(path) && \valid_read(place) && section_fits(section_at(path, place->section));
    requires place->accel <= PATH_ACCEL_MAX;
    assigns \nothing;
    ensures \result == grains_of(section_at(path, place->section), place) && 2048 <= \result <= 0x20000000000;
*/
uint64_t path_lay_grains(const struct path *path, const struct path_place *place);

/* Steps of an axis, and pulses of it up to a place that a section has. */
/*@ logic integer axis_steps(struct path_section *s, integer axis) =
        s->vector.steps[axis] < 0 ? -s->vector.steps[axis] : s->vector.steps[axis];
    predicate axes_fit(struct path_section *s) =
        section_fits(s) && axis_steps(s, 0) <= s->length && axis_steps(s, 1) <= s->length &&
        axis_steps(s, 2) <= s->length && axis_steps(s, 3) <= s->length;
    predicate place_fits(struct path_section *s, struct path_place *place) =
        axes_fit(s) && place->accel <= PATH_ACCEL_MAX && value(place->entry.place) <= grains_of(s, place) * s->length;
    predicate pulses_are(struct path_section *s, struct path_place *place, integer axis, integer pulses) =
        0 <= pulses <= axis_steps(s, axis) && quotient_of(value(place->entry.place) * axis_steps(s, axis),
            grains_of(s, place) * s->length, pulses);
*/

/*@ requires is_path(path) && \valid_read(place) && place_fits(section_at(path, place->section), place);
    requires \valid(pulses + (0 .. PATH_AXES - 1)) && \separated(pulses + (0 .. PATH_AXES - 1), path);
    requires \separated(pulses + (0 .. PATH_AXES - 1), place);
    requires \separated(pulses + (0 .. PATH_AXES - 1), path->ring + (0 .. path->size - 1));
    assigns pulses[0 .. PATH_AXES - 1];
    ensures pulses_are(section_at(path, place->section), place, 0, pulses[0]);
    ensures pulses_are(section_at(path, place->section), place, 1, pulses[1]);
    ensures pulses_are(section_at(path, place->section), place, 2, pulses[2]);
    ensures pulses_are(section_at(path, place->section), place, 3, pulses[3]);
*/
void path_lay_pulses(const struct path *path, const struct path_place *place, uint32_t pulses[PATH_AXES]);

#endif
