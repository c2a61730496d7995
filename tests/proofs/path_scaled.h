/*
 * What path_divide.c does around its digits: dividend and divisor are shifted up, and the rest back. The lemmas are of
 * whole numbers only.
 */
#ifndef PATH_SCALED_H
#define PATH_SCALED_H

#include "shifted.h"

/*@ predicate digits_found(integer rest, integer next, integer divisor, integer quotient, integer left) =
        rest * 0x10000000000000000 + next == quotient * divisor + left && 0 <= left < divisor;
*/

/* x / n with both times up. */
/*@ predicate times_up(integer x, integer n, integer up, integer words) =
        0 <= x && 1 <= n && 1 <= up && 0 <= words && x < n * words;
    lemma times_up_less: \forall integer x, n, up, words; times_up(x, n, up, words) ==> x * up < n * words * up;
    lemma times_up: \forall integer x, n, up, words; times_up(x, n, up, words) ==> x * up < n * up * words;
    predicate moved_all(integer high, integer low, integer up, integer down, integer scaled) =
        0 <= high < 0x10000000000000000 && moved(low, up, down, low / down, low % down) &&
        0x8000000000000000 <= scaled < 0x10000000000000000 &&
        (high * 0x10000000000000000 + low) * up < scaled * 0x10000000000000000;
    lemma moved_all_sum: \forall integer high, low, up, down, scaled; moved_all(high, low, up, down, scaled) ==>
        (high * 0x10000000000000000 + low) * up ==
            (high * up + low / down) * 0x10000000000000000 + low % down * up;
    lemma moved_all_less: \forall integer high, low, up, down, scaled; moved_all(high, low, up, down, scaled) ==>
        high * up + low / down < scaled;
    lemma moved_all_least: \forall integer high, low, up, down, scaled; moved_all(high, low, up, down, scaled) ==>
        0 <= high * up;

    predicate scaled_quotient(integer x, integer n, integer up, integer quotient, integer rest) =
        x * up == quotient * (n * up) + rest && 0 <= rest < n * up && 1 <= up && 1 <= n;
    predicate equal_by(integer a, integer b, integer factor) = a == b && 0 <= factor;
    lemma equal_by: \forall integer a, b, factor; equal_by(a, b, factor) ==> factor * a == factor * b;
    lemma scaled_rest: \forall integer x, n, up, quotient, rest; scaled_quotient(x, n, up, quotient, rest) ==>
        rest == (x - quotient * n) * up;
    predicate factor_of(integer x, integer n, integer up) = 0 <= x * up < n * up && 1 <= up;
    lemma factor_most: \forall integer x, n, up; factor_of(x, n, up) && n <= x ==> n * up <= x * up;
    lemma factor_least: \forall integer x, n, up; factor_of(x, n, up) && x <= -1 ==> x * up <= -1 * up;
    lemma factor_of: \forall integer x, n, up; factor_of(x, n, up) ==> 0 <= x < n;
    lemma factor_quotient: \forall integer x, n, up; factor_of(x, n, up) ==> x * up / up == x;
    lemma scaled_factor: \forall integer x, n, up, quotient, rest; scaled_quotient(x, n, up, quotient, rest) ==>
        factor_of(x - quotient * n, n, up);
    lemma scaled_back: \forall integer x, n, up, quotient, rest; scaled_quotient(x, n, up, quotient, rest) ==>
        0 <= x - quotient * n < n && rest / up == x - quotient * n;
    predicate top(integer x, integer low, integer up) = low <= x < 2 * low && 1 <= low && 1 <= up;
    lemma top_parts: \forall integer x, low, up; top(x, low, up) ==>
        (x - low) * up == x * up - low * up && (2 * low - 1 - x) * up == 2 * (low * up) - up - x * up;
    lemma top_least: \forall integer x, low, up; top(x, low, up) ==> low * up <= x * up;
    lemma top_most: \forall integer x, low, up; top(x, low, up) ==> x * up + up <= 2 * (low * up);
    lemma whole_quotient: \forall integer x, up; 0 <= x && 1 <= up ==> x * up / up == x;
*/
#endif
