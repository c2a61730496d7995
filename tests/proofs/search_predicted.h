/*
 * The interval that is predicted on a ramp, proved with step_generator_predict.acsl.
 */
#ifndef SEARCH_PREDICTED_H
#define SEARCH_PREDICTED_H

#include <stdint.h>

#include "search_guesses.h"

/* What is predicted is not much later than what a speed half a unit of the high word lower gives. */
/*@ predicate is_predicted(integer ticks, integer r, integer about) = 0 <= ticks <= 0x40000000 &&
        ticks * (about - 0x80000000) <= STEP_QUANTA - r + about / 2 + 0x200000000;
*/

/*@ requires 0x200000000 <= slope < 0x2000000000000000;
    requires -0x1000000000000000 <= signed_64(residual) <= 0x1000000000000000;
    assigns \nothing;
    ensures is_predicted(\result, signed_64(residual), slope);
*/
static inline uint32_t step_generator_predict(uint64_t residual, uint64_t slope);

#endif
