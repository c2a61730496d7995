/*
 * Laying: the sections of a path become courses, one after the other, as time comes near. A stage of path.h.
 */
#ifndef PATH_LAY_H
#define PATH_LAY_H

#include <stddef.h>
#include <stdint.h>

#include "path.h"

/* The plan begins at a place, with nothing handed over after it. */
void path_lay_begin(struct path *path, const struct path_place *place);

/* Lays the section path->laid, so that its plan stands. There must be one that is known. */
void path_lay_next(struct path *path);

/* Lays the course of a section once more, as it is not kept. */
const struct path_course *path_lay_anew(struct path *path, uint32_t count);

/* The course of the section of a count, which has been laid; right until another one is asked for. */
static inline const struct path_course *path_lay_course(struct path *path, uint32_t count)
{
    const struct path_kept *kept = &path->kept[count % PATH_KEPT];
    return kept->valid && kept->section == count ? &kept->course : path_lay_anew(path, count);
}

/* The section of the origin as it goes up to there, where the path was changed in it; NULL: that is not kept. */
static inline const struct path_kept *path_lay_before(const struct path *path)
{
    return path->before != NULL && path->before->valid ? path->before : NULL;
}

/* In which a place counts: so many are a step. */
uint64_t path_lay_grains(const struct path *path, const struct path_place *place);

/* Pulses of each axis in the section of a place, up to it. */
void path_lay_pulses(const struct path *path, const struct path_place *place, uint32_t pulses[PATH_AXES]);

#endif
