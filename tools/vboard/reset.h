/*
 * The reset line of the part: who pulls it, and whether somebody does. The board resets the part at the next boundary.
 */
#ifndef RESET_H
#define RESET_H

#include "clock.h"

/* Why the part was reset; the flags of RCC_CSR follow from it. */
enum reset_cause {
    RESET_NONE,
    RESET_POWER,
    RESET_SOFTWARE,
    RESET_WATCHDOG,
    RESET_PIN,
    RESET_BROWN_OUT, /* the supply was too low, but not so low that the RAM forgets */
    RESET_HELD,      /* the supply is too low: the part stands still */
    RESET_CAUSES,
};

struct reset {
    struct clock *clock;
    enum reset_cause wanted;
};

/* The first one counts, but for RESET_HELD. */
static inline void reset_request(struct reset *reset, enum reset_cause cause)
{
    if (reset->wanted == RESET_NONE || cause == RESET_HELD) {
        reset->wanted = cause;
    }
    clock_poke(reset->clock);
}

#endif
