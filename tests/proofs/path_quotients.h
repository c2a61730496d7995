/*
 * Contracts of path_divide.h, proved with path_divide.acsl, path_divide_fixed.acsl and path_divide_wide.acsl: exact for
 * all operands that the header allows.
 */
#ifndef PATH_QUOTIENTS_H
#define PATH_QUOTIENTS_H

#include "path_reciprocals.h"
#include "shifts.h"
#include "wide.h"

#include "path_divide.h"

/* A divisor that is ready, and the number that it stands for. */
/*@ logic integer number(struct path_divisor d) = d.scaled / power(d.shift);
    predicate is_ready(struct path_divisor d) =
        d.shift <= 63 && 0x8000000000000000 <= d.scaled && is_reciprocal(d.scaled, d.reciprocal) &&
        number(d) * power(d.shift) == d.scaled && 1 <= number(d) <= 0xFFFFFFFFFFFFFFFF;
    predicate divided(integer dividend, integer divisor, integer quotient, integer rest) =
        dividend == quotient * divisor + rest && 0 <= rest < divisor;
    predicate divided_down(integer dividend, integer divisor, integer quotient) =
        quotient * divisor <= dividend < quotient * divisor + divisor;
*/

/*@ requires 1 <= divisor;
    assigns \nothing;
    ensures is_ready(\result) && number(\result) == divisor;
*/
struct path_divisor path_divisor_of(uint64_t divisor);

/*@ requires \valid(rest) && \valid_read(divisor) && \separated(rest, divisor);
    requires is_ready(*divisor) && value(dividend) < number(*divisor) * 0x10000000000000000;
    assigns *rest;
    ensures divided(value(dividend), number(*divisor), \result, *rest);
*/
uint64_t path_divide(struct wide dividend, const struct path_divisor *divisor, uint64_t *rest);

/*@ requires \valid_read(divisor);
    requires is_ready(*divisor) && value(dividend) < number(*divisor) * 0x10000000000000000;
    assigns \nothing;
    ensures divided_down(value(dividend) * 0x10000000000000000, number(*divisor), value(\result));
*/
struct wide path_divide_fixed(struct wide dividend, const struct path_divisor *divisor);

/*@ requires \valid_read(divisor) && is_ready(*divisor);
    assigns \nothing;
    ensures divided_down(value(dividend), number(*divisor), value(\result));
*/
struct wide path_divide_wide(struct wide dividend, const struct path_divisor *divisor);

#endif
