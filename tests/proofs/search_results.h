/*
 * What a correction of the search achieves, whichever way it goes, for position and slope as the code computes them.
 */
#ifndef SEARCH_RESULTS_H
#define SEARCH_RESULTS_H

#include "search_ends.h"

/*@ predicate is_bettered(integer r, integer s, integer a, integer r2, integer s2) =
        is_guess(r2, s2, a) && s2 <= s + 0x800000000000 &&
        (!is_close(r, s) ==> is_tame(r2, s2, a)) &&
        (!is_close(r, s) && is_tame(r, s, a) ==> 2 * size(r2) <= size(r)) &&
        (is_close(r, s) ==> is_closer(r2, s2)) && (is_closer(r, s) ==> is_closest(r2, s2)) &&
        (is_closest(r, s) ==> is_near(r2, s2));
    lemma bettered_above_far: \forall integer r, s, a, r2, s2; 0 < s && is_beyond(r, s) &&
        approaches(r, s, a, r2, s2) ==> is_bettered(r, s, a, r2, s2);
    lemma bettered_below_far: \forall integer r, s, a, r2, s2; 0 < s && is_beyond(r, s) &&
        approaches(r, s, a, r2, s2) ==> is_bettered(-r, s, -a, -r2, s2);
    lemma bettered_above_close: \forall integer r, s, a, r2, s2; 0 < s && s - s / 2 < r && is_close(r, s) &&
        arrives(r, s, a, r2, s2) && (is_closest(r, s) ==> ends_near(r, s, r2, s2)) ==> is_bettered(r, s, a, r2, s2);
    lemma bettered_below_close: \forall integer r, s, a, r2, s2; 0 < s && s / 2 < r && is_close(r, s) &&
        arrives(r, s, a, r2, s2) && (is_closest(r, s) ==> ends_near(r, s, r2, s2)) ==>
            is_bettered(-r, s, -a, -r2, s2);
*/
/*@ lemma up_above: \forall integer q, r, s, a, r2, s2; 0 <= a && s - s / 2 < r &&
        corrects(q, r, s, a, r2, s2) ==> is_bettered(r, s, a, r2, s2);
    lemma up_below: \forall integer q, r, s, a, r2, s2; 0 <= a && s / 2 < r &&
        corrects(q, r, s, a, r2, s2) ==> is_bettered(-r, s, -a, -r2, s2);
    lemma down_above: \forall integer q, r, s, a, b, r2, s2; s - s / 2 < r &&
        falls(q, r, s, a, b, r2, s2) ==> is_bettered(r, s, a, r2, s2);
    lemma down_below: \forall integer q, r, s, a, b, r2, s2; s / 2 < r &&
        falls(q, r, s, a, b, r2, s2) ==> is_bettered(-r, s, -a, -r2, s2);
*/
/*@ predicate is_earlier(integer q, integer r, integer s, integer a) =
        s < 0x400000000000000 && is_guess(r, s, a) && s - s / 2 < r && is_quotient(q, r, s);
    predicate is_later(integer q, integer r, integer s, integer a) =
        s < 0x400000000000000 && is_guess(r, s, a) && r < -(s / 2) && is_quotient(q, -r, s);
    lemma corrected_earlier: \forall integer q, r, s, a;
        is_corrected(q, r, s, a, position(r, s, a, -q), speed(s, a, -q));
    lemma corrected_later: \forall integer q, r, s, a;
        is_corrected(q, -r, s, -a, -position(r, s, a, q), speed(s, a, q));
    lemma earlier_corrects: \forall integer q, r, s, a; is_earlier(q, r, s, a) ==>
        corrects(q, r, s, a, position(r, s, a, -q), speed(s, a, -q));
    lemma earlier_up: \forall integer q, r, s, a; 0 <= a && is_earlier(q, r, s, a) ==>
        is_bettered(r, s, a, position(r, s, a, -q), speed(s, a, -q));
    lemma earlier_falls: \forall integer q, r, s, a, b; is_opposite(a, b) && 0 <= b && is_earlier(q, r, s, a) ==>
        falls(q, r, s, a, b, position(r, s, a, -q), speed(s, a, -q));
    lemma earlier_down: \forall integer q, r, s, a, b; is_opposite(a, b) && 0 <= b && is_earlier(q, r, s, a) ==>
        is_bettered(r, s, a, position(r, s, a, -q), speed(s, a, -q));
    lemma later_corrects: \forall integer q, r, s, a; is_later(q, r, s, a) ==>
        corrects(q, -r, s, -a, -position(r, s, a, q), speed(s, a, q));
    lemma later_up: \forall integer q, r, s, a; a <= 0 && is_later(q, r, s, a) ==>
        is_bettered(r, s, a, position(r, s, a, q), speed(s, a, q));
    lemma later_falls: \forall integer q, r, s, a; is_opposite(-a, a) && 0 <= a && is_later(q, r, s, a) ==>
        falls(q, -r, s, -a, a, -position(r, s, a, q), speed(s, a, q));
    lemma later_down: \forall integer q, r, s, a; is_opposite(-a, a) && 0 <= a && is_later(q, r, s, a) ==>
        is_bettered(r, s, a, position(r, s, a, q), speed(s, a, q));
*/
#endif
