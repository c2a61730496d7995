/*
 * Shifts by 15 and 17 bits, and the mask of 17 bits.
 */
#ifndef PATH_BITS_H
#define PATH_BITS_H

#include "digits.h"
#include "masks.h"

/*@ lemma power_15: power(15) == 32768;
    lemma up_15: \forall integer x; 0 <= x ==> (x << 15) == x * 32768;
    lemma up_17: \forall integer x; 0 <= x ==> (x << 17) == x * 131072;
    lemma down_17: \forall integer x; 0 <= x ==> (x >> 17) == x / 131072;
    predicate joins_15(integer part, integer x, integer y) = 0 <= part && x == part * 32768 && 0 <= y < 32768;
    lemma joins_15: \forall integer part, x, y; joins_15(part, x, y) ==> joins(part, x, y, 15);
    lemma join_15: \forall integer part, x, y; joins_15(part, x, y) ==> joined(x, y, x + y) && joined(y, x, x + y);
    predicate joins_17(integer part, integer x, integer y) = 0 <= part && x == part * 131072 && 0 <= y < 131072;
    lemma joins_17: \forall integer part, x, y; joins_17(part, x, y) ==> joins(part, x, y, 17);
    lemma join_17: \forall integer part, x, y; joins_17(part, x, y) ==> joined(x, y, x + y) && joined(y, x, x + y);

    lemma masked_high: \forall uint32_t x, m, over; m == (x & 0x1FFFF) && over == (m >> 17) ==> over == 0;
    lemma masked_last: \forall uint32_t x, m; m == (x & 0x1FFFF) ==> (m & 0xFFFF) == (x & 0xFFFF);
    lemma masked_odd: \forall uint32_t x, m; m == (x & 0x1FFFF) ==> (((m >> 16) & 1) == 0 <==> ((x >> 16) & 1) == 0);
    lemma masked_down: \forall uint32_t x, m, over; m == (x & 0x1FFFF) && over == (m >> 17) ==> m < 131072;
    lemma masked_low: \forall uint32_t x, m; (m & 0xFFFF) == (x & 0xFFFF) ==> m % 65536 == x % 65536;
    predicate odd_16(integer x) = 0 <= x;
    lemma odd_16: \forall integer x; odd_16(x) ==> ((x >> 16) & 1) == x / 65536 % 2;
    lemma masked_top: \forall uint32_t x, m; m == (x & 0x1FFFF) && odd_16(m) && odd_16(x) ==>
        m / 65536 == x / 65536 % 2;
    lemma masked_17: \forall uint32_t x, m, over; m == (x & 0x1FFFF) && over == (m >> 17) && odd_16(m) && odd_16(x) ==>
        m == x % 131072;
*/
#endif
