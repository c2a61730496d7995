/*
 * Powers of 2, and shifts by a number of bits that is a variable, for numbers that are not negative. As in numbers.h,
 * the `admit lemma`s are assumed.
 */
#ifndef SHIFTS_H
#define SHIFTS_H

/*@ axiomatic Powers {
      logic integer power(integer n);
    }
    admit lemma power: \forall integer n; 0 <= n ==> 1 <= power(n) && (1 << n) == power(n);
    predicate timed(integer x, integer n) = 0 <= n;
    lemma times: \forall integer x, n; timed(x, n) ==> x * (1 << n) == x * power(n);
    admit lemma power_sum: \forall integer n, m, sum; 0 <= n && 0 <= m && n + m == sum ==>
        power(n) * power(m) == power(sum);
    admit lemma powers: power(1) == 2 && power(31) == 0x80000000 && power(32) == 0x100000000 &&
        power(63) == 0x8000000000000000 && power(64) == 0x10000000000000000;
    lemma power_next: \forall integer n, next; 0 <= n && n + 1 == next ==> 2 * power(n) == power(next);
    admit lemma up: \forall integer x, n; 0 <= x && 0 <= n ==> (x << n) == x * power(n);
    admit lemma down: \forall integer x, n; 0 <= x && 0 <= n ==> (x >> n) == x / power(n);
    predicate joins(integer part, integer x, integer y, integer n) =
        0 <= part && 0 <= n && x == part * power(n) && 0 <= y < power(n);
    predicate joined(integer x, integer y, integer sum) = (x | y) == sum;
    admit lemma join: \forall integer part, x, y, n; joins(part, x, y, n) ==>
        joined(x, y, x + y) && joined(y, x, x + y);
*/
#endif
