/*
 * Contract of path_root.h, proved with path_root_nearest.acsl.
 */
#ifndef PATH_ROOTS_H
#define PATH_ROOTS_H

#include "wide.h"

/*@ predicate nearest_below(integer value, integer root) = 1 <= root && root * root - root < value; */

/*@ requires value(value) < 0x40000000000000000000000000000000;
    assigns \nothing;
    ensures \result * \result - \result <= value(value) <= \result * \result + \result;
    ensures 0 < value(value) ==> nearest_below(value(value), \result);
    ensures value.high == 0 && 0 < value.low ==> nearest_below(value.low, \result);
*/
uint64_t path_root(struct wide value);

#endif
