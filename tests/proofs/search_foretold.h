/*
 * The interval that is foretold on a ramp, proved with step_generator_foretell.acsl.
 */
#ifndef SEARCH_FORETOLD_H
#define SEARCH_FORETOLD_H

#include <stdint.h>

#include "search_guesses.h"

/* What is foretold is not much later than what a speed half a unit of the high word lower gives. */
/*@ predicate is_foretold(integer ticks, integer r, integer about) = 0 <= ticks <= 0x40000000 &&
        ticks * (about - 0x80000000) <= STEP_QUANTA - r + about / 2 + 0x200000000;
*/

/*@ requires 0x200000000 <= slope < 0x2000000000000000;
    requires -0x1000000000000000 <= signed_64(residual) <= 0x1000000000000000;
    assigns \nothing;
    ensures is_foretold(\result, signed_64(residual), slope);
*/
static inline uint32_t step_generator_foretell(uint64_t residual, uint64_t slope);

#endif
