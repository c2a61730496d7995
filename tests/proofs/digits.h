/*
 * Shifts by 1, 16, 17, 31 and 33 bits, the mask of 1 bit, sums of bits, and wraps of 64 bits.
 */
#ifndef DIGITS_H
#define DIGITS_H

#include "numbers.h"
#include "shifts.h"

/*@ lemma wraps_none: \forall integer x; 0 <= x < 0x10000000000000000 ==> (uint64_t)x == x;
    lemma wraps_none_32: \forall integer x; 0 <= x < 0x100000000 ==> (uint32_t)x == x;
    lemma wraps_below: \forall integer x; -0x10000000000000000 <= x < 0 ==> (uint64_t)x == x + 0x10000000000000000;
    lemma wraps_above: \forall integer x; 0x10000000000000000 <= x < 0x20000000000000000 ==>
        (uint64_t)x == x - 0x10000000000000000;
*/

/*@ lemma power_2: power(2) == 4;
    lemma power_4: power(4) == 16;
    lemma power_8: power(8) == 256;
    lemma power_16: power(16) == 65536;
    lemma power_17: power(17) == 131072;
    lemma power_33: power(33) == 0x200000000;

    lemma up_16: \forall integer x; 0 <= x ==> (x << 16) == x * 65536;
    lemma down_16: \forall integer x; 0 <= x ==> (x >> 16) == x / 65536;
    predicate joins_16(integer part, integer x, integer y) = 0 <= part && x == part * 65536 && 0 <= y < 65536;
    lemma joins_16: \forall integer part, x, y; joins_16(part, x, y) ==> joins(part, x, y, 16);
    lemma join_16: \forall integer part, x, y; joins_16(part, x, y) ==> joined(x, y, x + y) && joined(y, x, x + y);
    predicate joins_31(integer part, integer x, integer y) =
        0 <= part && x == part * 0x80000000 && 0 <= y < 0x80000000;
    lemma joins_31: \forall integer part, x, y; joins_31(part, x, y) ==> joins(part, x, y, 31);
    lemma join_31: \forall integer part, x, y; joins_31(part, x, y) ==> joined(x, y, x + y) && joined(y, x, x + y);
    predicate joins_32(integer part, integer x, integer y) =
        0 <= part && x == part * 0x100000000 && 0 <= y < 0x100000000;
    lemma joins_32: \forall integer part, x, y; joins_32(part, x, y) ==> joins(part, x, y, 32);
    lemma joined_32: \forall integer part, x, y; joins_32(part, x, y) ==> joined(x, y, x + y) && joined(y, x, x + y);
    lemma up_31: \forall integer x; 0 <= x ==> (x << 31) == x * 0x80000000;
    lemma down_33: \forall integer x; 0 <= x ==> (x >> 33) == x / 0x200000000;
    lemma up_1: \forall integer x; 0 <= x ==> (x << 1) == x * 2;
    predicate joins_1(integer part, integer x, integer y) = 0 <= part && x == part * 2 && 0 <= y < 2;
    lemma joins_1: \forall integer part, x, y; joins_1(part, x, y) ==> joins(part, x, y, 1);
    lemma join_1: \forall integer part, x, y; joins_1(part, x, y) ==> joined(x, y, x + y) && joined(y, x, x + y);

    lemma halves: \forall integer x; 0 <= x ==> joins(x / 2, (x / 2) << 1, x % 2, 1);
    lemma halves_join: \forall integer x; 0 <= x ==> (((x / 2) << 1) | (x % 2)) == x;
    lemma halves_last: \forall integer half, last; 0 <= half && 0 <= last <= 1 ==> (((half << 1) | last) & 1) == last;
    lemma mask_1: \forall integer x; 0 <= x ==> (x & 1) == x % 2;
*/

/*@ predicate sums(integer n, integer m, integer sum) = 0 <= n && 0 <= m && n + m == sum;
    lemma sums: \forall integer n, m, sum; sums(n, m, sum) ==> power(n) * power(m) == power(sum);
    predicate is_wrapped(integer x, integer wraps, integer rest) =
        x == wraps * 0x10000000000000000 + rest && 0 <= rest < 0x10000000000000000;
    lemma is_wrapped: \forall integer x, wraps, rest; is_wrapped(x, wraps, rest) ==> (uint64_t)x == rest;
*/
#endif
