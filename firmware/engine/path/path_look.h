/*
 * Look-ahead: the speeds at the borders of a path, as high as the vectors and the borders allow. A stage of path.h.
 */
#ifndef PATH_LOOK_H
#define PATH_LOOK_H

#include <stdbool.h>
#include <stdint.h>

#include "path.h"

/* The section of a count. */
static inline struct path_section *path_section_of(const struct path *path, uint32_t section)
{
    return &path->ring[section & (path->size - 1U)];
}

/* Plans what has not been laid, from path->next on, which is in the section path->laid, up to path->known, which is a
 * later one. */
void path_look(struct path *path);

/* The same after a section has been added and nothing else: only as far back as that changes a speed. Returns the first
 * section whose plan is another one. Not with a start speed. */
uint32_t path_look_again(struct path *path);

/* The most with which section `section` may be entered, so that what follows can be braked to: from its plan and the
 * caps of its beginning, in terms of border speeds. `section` is not the first in the ring. */
uint64_t path_look_brakeable(const struct path *path, uint32_t section);

/* Whether the section of a count is the one in which the path began or was changed: there it may take speeds up to the
 * start speed at once. */
static inline bool path_look_jumps(const struct path *path, uint32_t section)
{
    return !path->stopping && section == path->origin.section;
}

/* The square of the start speed, in a vector's own terms. */
static inline uint64_t path_look_start2(const struct path *path)
{
    return (uint64_t)path->start_speed * path->start_speed;
}

/* What the square of the speed can gain or lose from path->next to the end of its section. */
uint64_t path_look_gain(const struct path *path);

#endif
