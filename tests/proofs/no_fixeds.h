/*
 * The contract of path_fixed.h for what asks for no quotient.
 */
#ifndef NO_FIXEDS_H
#define NO_FIXEDS_H

#include "path_fixed.h"

/*@ requires \false;
    assigns \nothing;
*/
struct wide path_fixed_divide(struct wide dividend, uint64_t divisor);

#endif
