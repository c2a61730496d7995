/*
 * Counts that wrap at 2^32, of places in a ring whose size is a power of 2. As in numbers.h, the `admit lemma` is
 * assumed.
 */
#ifndef RINGS_H
#define RINGS_H

#include "numbers.h"
#include "shifts.h"
#include "squares.h"

/*@ admit lemma mask: \forall integer x, size, n; 0 <= x && 0 <= n && size == power(n) ==>
        (x & (size - 1)) == x % size;

    predicate rest_of(integer x, integer size, integer quotient, integer rest) =
        x == quotient * size + rest && 0 <= rest < size;
    lemma rest_less: \forall integer x, size, a, b, rest, other; rest_of(x, size, a, rest) &&
        rest_of(x, size, b, other) && a + 1 <= b ==> ordered_by(a + 1, b, size);
    lemma rest_order: \forall integer x, size, a, b, rest, other; rest_of(x, size, a, rest) &&
        rest_of(x, size, b, other) ==> b <= a;
    lemma rest_quotient: \forall integer x, size, a, b, rest, other; rest_of(x, size, a, rest) &&
        rest_of(x, size, b, other) ==> a == b;
    lemma rest_equal: \forall integer x, size, a, rest, other; rest_of(x, size, a, rest) &&
        rest_of(x, size, a, other) ==> rest == other;
    lemma rest_same: \forall integer x, size, a, b, rest, other; rest_of(x, size, a, rest) &&
        rest_of(x, size, b, other) ==> rest == other;
    lemma rest_split: \forall integer x, size; 0 <= x && 1 <= size ==> rest_of(x, size, x / size, x % size);
    lemma rest_is: \forall integer x, size, quotient, rest; 0 <= x && rest_of(x, size, quotient, rest) ==>
        x % size == rest;
    predicate turned(integer x, integer size, integer turns, integer y) =
        0 <= x && 1 <= size && y == x + turns * size && 0 <= y;
    lemma turned_rest: \forall integer x, size, turns, y; turned(x, size, turns, y) ==>
        rest_of(y, size, x / size + turns, x % size);
    lemma turned: \forall integer x, size, turns, y; turned(x, size, turns, y) ==> y % size == x % size;

    predicate sized(integer size, integer n, integer m) = 1 <= n && 1 <= m && n + m == 32 && size == power(n);
    predicate is_ring_size(integer size) = \exists integer n, m; sized(size, n, m);
    predicate product_is(integer a, integer b, integer product) = a * b == product;
    lemma ring_powers: \forall integer size, n, m; sized(size, n, m) ==> product_is(power(m), power(n), power(32));
    lemma ring_parts: \forall integer size, n, m; sized(size, n, m) ==> product_is(power(m), size, 0x100000000);
    logic integer wrapped(integer x) = x < 0x100000000 ? x : x - 0x100000000;
    lemma ring_turned: \forall integer x, size, n, m; sized(size, n, m) && 0x100000000 <= x ==>
        turned(wrapped(x), size, power(m), x);
    lemma ring_wraps: \forall integer x, size, n, m; sized(size, n, m) && 0x100000000 <= x ==>
        wrapped(x) % size == x % size;
    lemma ring_wrapped: \forall integer x, size; is_ring_size(size) && 0 <= x ==> wrapped(x) % size == x % size;
    lemma ring_mask: \forall integer x, size; is_ring_size(size) && 0 <= x ==> (x & (size - 1)) == x % size;
    lemma ring_size: \forall integer size; is_ring_size(size) ==> 2 <= size;
    predicate apart(integer size, integer a, integer b) = 0 <= a < b < a + size;
    lemma apart_split: \forall integer size, a, b; apart(size, a, b) ==> rest_of(b, size, b / size, b % size) &&
        rest_of(a, size, a / size, a % size);
    lemma apart_less: \forall integer size, a, b; apart(size, a, b) && a / size + 1 <= b / size ==>
        ordered_by(a / size + 1, b / size, size);
    lemma apart_same: \forall integer size, a, b; apart(size, a, b) && a / size == b / size ==> a % size != b % size;
    lemma apart: \forall integer size, a, b; apart(size, a, b) ==> a % size != b % size;
*/
#endif
