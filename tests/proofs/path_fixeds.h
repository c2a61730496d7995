/*
 * Contracts of path_fixed.h, proved with path_fixed.acsl: rounded down.
 */
#ifndef PATH_FIXEDS_H
#define PATH_FIXEDS_H

#include "path_quotients.h"
#include "wide.h"

#include "path_fixed.h"

/*@ requires 1 <= divisor && value(dividend) < divisor * 0x10000000000000000;
    assigns \nothing;
    ensures divided_down(value(dividend) * 0x10000000000000000, divisor, value(\result));
*/
struct wide path_fixed_divide(struct wide dividend, uint64_t divisor);

/*@ assigns \nothing;
    ensures a.high * b.high > PATH_FIXED_NEVER ==> value(\result) == PATH_FIXED_NEVER * 0x10000000000000000;
    ensures a.high * b.high <= PATH_FIXED_NEVER ==>
        divided_down(value(a) * value(b), 0x10000000000000000, value(\result));
*/
struct wide path_fixed_multiply(struct wide a, struct wide b);

#endif
