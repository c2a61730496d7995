/*
 * Shifts by 8, 48 and 55 bits.
 */
#ifndef COURSE_SHIFTS_H
#define COURSE_SHIFTS_H

#include "digits.h"

/*@ lemma power_48: sums(32, 16, 48) && power(48) == 0x1000000000000;
    lemma power_55: sums(8, 55, 63) && power(55) == 0x80000000000000;
    lemma up_8: \forall integer x; 0 <= x ==> (x << 8) == x * 256;
    lemma down_8: \forall integer x; 0 <= x ==> (x >> 8) == x / 256;
    lemma down_48: \forall integer x; 0 <= x ==> (x >> 48) == x / 0x1000000000000;
    lemma down_55: \forall integer x; 0 <= x ==> (x >> 55) == x / 0x80000000000000;
*/
#endif
