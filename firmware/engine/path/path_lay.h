/*
 * Laying: the sections of a path become courses, one after the other, as time comes near. A stage of path.h.
 */
#ifndef PATH_LAY_H
#define PATH_LAY_H

#include <stdint.h>

#include "path.h"

/* The plan begins at a place, with nothing handed over after it. */
void path_lay_begin(struct path *path, const struct path_place *place);

/* Lays the section path->laid, so that its plan stands. There must be one that is known. */
void path_lay_next(struct path *path);

/* The course of the section of a count, which has been laid; right until another one is asked for. */
const struct path_course *path_lay_course(struct path *path, uint32_t count);

/* In which a place counts: so many are a step. */
uint64_t path_lay_grains(const struct path *path, const struct path_place *place);

/* Pulses of an axis in the section of a place, up to it. */
uint32_t path_lay_pulses(const struct path *path, const struct path_place *place, unsigned axis);

#endif
