/*
 * What proofs of arithmetic need: true of C and ACSL, but not known to the provers.
 *
 * WP 25 tells its provers nothing of what a conversion to an unsigned type makes of a number that does not fit, and
 * little of shifts and masks. The `admit lemma`s say it; they are assumed. All other lemmas are proved.
 */
#ifndef NUMBERS_H
#define NUMBERS_H

#include <stdint.h>

/* C11 6.3.1.3: what does not fit is reduced modulo 2^32 or 2^64. */
/*@ axiomatic Wraps {
      logic integer wraps_32(integer x);
      logic integer wraps_64(integer x);
    }
    admit lemma wrap_32: \forall integer x; (uint32_t)x == x - wraps_32(x) * 0x100000000;
    admit lemma wrap_64: \forall integer x; (uint64_t)x == x - wraps_64(x) * 0x10000000000000000;

    lemma wraps_once_32: \forall integer x, wraps; 0 <= x - wraps * 0x100000000 < 0x100000000 ==>
        wraps_32(x) == wraps;
    lemma wraps_once_64: \forall integer x, wraps; 0 <= x - wraps * 0x10000000000000000 < 0x10000000000000000 ==>
        wraps_64(x) == wraps;
    lemma wrap_up: \forall integer x; 0 <= x ==> (uint64_t)(x * 0x100000000) == (x % 0x100000000) * 0x100000000;
    lemma wraps_sum_32: \forall integer x, y; wraps_32((uint32_t)x + y) == wraps_32(x + y) - wraps_32(x);
    lemma wrap_sum: \forall integer x, y; (uint32_t)((uint32_t)x + y) == (uint32_t)(x + y);
*/

/* Shifts and masks of numbers that are not negative. */
/*@ admit lemma mask_32: \forall integer x; 0 <= x ==> (x & 0xFFFFFFFF) == x % 0x100000000;
    admit lemma down_32: \forall integer x; 0 <= x ==> (x >> 32) == x / 0x100000000;
    admit lemma down_1: \forall integer x; 0 <= x ==> (x >> 1) == x / 2;
    admit lemma up_32: \forall integer x; 0 <= x ==> (x << 32) == x * 0x100000000;
    admit lemma join_32: \forall integer high, low; 0 <= high && 0 <= low < 0x100000000 ==>
        ((high * 0x100000000) | low) == high * 0x100000000 + low;
    admit lemma join_32_back: \forall integer high, low; 0 <= high && 0 <= low < 0x100000000 ==>
        (low | (high * 0x100000000)) == high * 0x100000000 + low;
    admit lemma odd: \forall integer x; 0 <= x ==> 1 <= (x | 1);
*/

#endif
