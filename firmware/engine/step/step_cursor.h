/*
 * How far the pulses of a channel have come: enough to look ahead at those that follow, and to plan from there.
 */
#ifndef STEP_CURSOR_H
#define STEP_CURSOR_H

#include <stdint.h>

#include "step_generator.h"

struct step_cursor {
    struct step_generator generator;
    uint64_t end;  /* ordinal in the move of the last pulse on the present segment */
    uint32_t left; /* pulses still to come on the present segment */
    uint32_t tail; /* count of segments taken from the queue */
};

/* The ordinal in the move of the pulse that a cursor stands on; 0 before the first. */
static inline uint64_t step_cursor_pulse(const struct step_cursor *cursor)
{
    return cursor->end - cursor->left;
}

#endif
