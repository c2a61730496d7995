/*
 * Look-ahead: the speeds at the borders of a path, as high as the vectors and the borders allow. A stage of path.h.
 */
#ifndef PATH_LOOK_H
#define PATH_LOOK_H

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

/* The most with which section `section` may be entered, so that what follows can be braked to: from its plan and the
 * caps of its beginning, in terms of border speeds. `section` is not the first in the ring. */
uint64_t path_look_brakeable(const struct path *path, uint32_t section);

/* What the square of the speed can gain or lose from path->next to the end of its section. */
uint64_t path_look_gain(const struct path *path);

#endif
