/*
 * A segment as tests look at it: it stands on its first pulse, its curve goes on to both sides.
 */
#ifndef SEGMENT_VIEW_H
#define SEGMENT_VIEW_H

#include "step_generator.h"

/* Position, since the last pulse before the segment, and slope at another tick. */
static inline struct step_generator seen_at(const struct step_segment *segment, uint32_t tick)
{
    struct step_generator generator = {.tick = tick};
    step_generator_join(&generator, segment, 0);
    return generator;
}

#endif
