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
 * later one: backward, so that from no border the next one is out of reach of the brake. What the ramps can reach is
 * seen forward, where a section is laid. */
void path_look(struct path *path);

/* The same after sections have been added and nothing else: only as far back as that changes a speed. Returns the first
 * section whose plan is another one. */
uint32_t path_look_again(struct path *path);

/* Does so if sections have been added and the plan of the section path->laid may be another one by them. */
void path_look_if_due(struct path *path);

/* Forward: with which a section is left that is entered with enter2, not faster than the ramp can get, nor slower than
 * the brake can: it is too fast only where it was planned so before a speed was lowered, and then brakes through as
 * many sections as that takes. In terms of border speeds. */
uint64_t path_look_exit2(const struct path *path, const struct path_section *section, uint64_t enter2);

/* The most with which a section that look-ahead knows may be entered, so that what follows can be braked to: from the
 * caps of its beginning and its plan, if it is entered with enter2. */
uint64_t path_look_brakeable(const struct path *path, uint32_t section, uint64_t enter2);

/* Whether the section path->laid might be entered with more than enter2. */
bool path_look_is_more(struct path *path, uint64_t enter2);

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
