/*
 * Numbers with their lowest bit set: that leaves an odd one as it is, and makes an even one the next.
 */
#ifndef ODDS_H
#define ODDS_H

#include "shifts.h"

/*@ lemma power_1: power(1) == 2;
    lemma power_1_twice: \forall integer half; half * power(1) == 2 * half;
    lemma odd_joins: \forall integer half; 0 <= half ==> joins(half, 2 * half, 1, 1);
    predicate is_odd(integer x, integer y) = x == (y | 1);
    lemma odd_again: \forall integer x, y; is_odd(x, y) ==> is_odd(x, x);
    lemma odd_joined: \forall integer half, x; joins(half, x, 1, 1) ==> joined(1, x, x + 1);
    lemma odd_next: \forall integer half, x; joins(half, x, 1, 1) ==> is_odd(x + 1, x);
    lemma odd_kept: \forall integer half, x; joins(half, x, 1, 1) ==> is_odd(x + 1, x + 1);
    predicate is_near_odd(integer x) = is_odd(x, x) || is_odd(x + 1, x);
*/
#endif
