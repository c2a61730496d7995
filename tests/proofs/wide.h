/*
 * Contracts of base_wide.h, proved with base_wide.acsl and base_wide_divide.acsl, the root excepted: exact for all
 * operands that the header allows.
 */
#ifndef WIDE_H
#define WIDE_H

#include "base_wide.h"

/*@ logic integer value(struct wide w) = w.high * 0x10000000000000000 + w.low; */

/*@ assigns \nothing;
    ensures value(\result) == a * b;
*/
struct wide wide_multiply(uint64_t a, uint64_t b);

/*@ assigns \nothing;
    ensures value(\result) == value(a) + value(b) ||
        value(\result) == value(a) + value(b) - 0x100000000000000000000000000000000;
*/
struct wide wide_add(struct wide a, struct wide b);

/*@ assigns \nothing;
    ensures value(\result) == value(a) - value(b) ||
        value(\result) == value(a) - value(b) + 0x100000000000000000000000000000000;
*/
struct wide wide_subtract(struct wide a, struct wide b);

/*@ requires bits <= 63;
    requires value(value) * (1 << bits) < 0x100000000000000000000000000000000;
    assigns \nothing;
    ensures value(\result) == value(value) * (1 << bits);
*/
struct wide wide_shift_left(struct wide value, unsigned bits);

/*@ assigns \nothing;
    ensures \result <==> value(a) >= value(b);
*/
bool wide_is_at_least(struct wide a, struct wide b);

/*@ requires 1 <= divisor <= 0x8000000000000000;
    requires \valid(remainder);
    assigns *remainder;
    ensures value.high >= divisor ==> \result == 0xFFFFFFFFFFFFFFFF && *remainder == 0;
    ensures value.high < divisor ==> \result * divisor + *remainder == value(value);
    ensures value.high < divisor ==> 0 <= *remainder < divisor;
*/
uint64_t wide_divide(struct wide value, uint64_t divisor, uint64_t *remainder);

/*@ requires 1 <= divisor <= 0x8000000000000000;
    assigns \nothing;
    ensures value(value) + divisor / 2 < divisor * 0x10000000000000000 ==>
        2 * value(value) - divisor <= 2 * \result * divisor <= 2 * value(value) + divisor;
    ensures value(value) + divisor / 2 < divisor * 0x10000000000000000 ==>
        \result * divisor <= value(value) + divisor / 2 < \result * divisor + divisor;
*/
uint64_t wide_divide_nearest(struct wide value, uint64_t divisor);

/*@ assigns \nothing;
    ensures \result == (factor * fraction + 0x80000000) / 0x100000000;
    ensures \result <= factor;
*/
uint64_t wide_scale(uint64_t factor, uint32_t fraction);

/*@ requires value(value) < 0x10000000000000000000000000000000;
    assigns \nothing;
    ensures \result * \result - \result <= value(value) <= \result * \result + \result;
*/
uint64_t wide_root_nearest(struct wide value);

#endif
