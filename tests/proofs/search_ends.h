/*
 * How a search ends: from four ticks off, three corrections are enough.
 */
#ifndef SEARCH_ENDS_H
#define SEARCH_ENDS_H

#include "search_steps.h"

/*@ predicate is_closer(integer r, integer s) = -(9 * s) <= 4 * r <= 9 * s;
    predicate is_closest(integer r, integer s) = -(19 * s) <= 20 * r <= 19 * s;
    predicate ends(integer q, integer r, integer s) =
        s < 0x400000000000000 && 1 <= q && s <= 2 * r && is_close(r, s) && is_quotient(q, r, s);
    lemma ends_4: \forall integer q, r, s; 0 < s && ends(q, r, s) ==> q <= 4;
    lemma ends_2: \forall integer q, r, s; 0 < s && ends(q, r, s) && is_closer(r, s) ==> q <= 2;
    lemma ends_1: \forall integer q, r, s; 0 < s && ends(q, r, s) && is_closest(r, s) ==> q == 1;

    predicate ends_up(integer q, integer r, integer s, integer a, integer r2, integer s2) =
        0 <= a && 20 * a <= s && 21000000000 <= s && ends(q, r, s) && is_corrected(q, r, s, a, r2, s2);
    predicate ends_down(integer q, integer r, integer s, integer b, integer r2, integer s2) =
        0 <= b <= 1024000000 && 10 * b <= s && 0x280000000 <= s && ends(q, r, s) && is_sunk(q, r, s, b, r2, s2);
    lemma end_up_4_gain: \forall integer q, r, s, a, r2, s2; ends_up(q, r, s, a, r2, s2) ==> is_gain(q, a, 4);
    lemma end_up_4: \forall integer q, r, s, a, r2, s2; ends_up(q, r, s, a, r2, s2) ==>
        3 * s <= 5 * s2 && s2 <= s && is_closer(r2, s2);
    lemma end_up_2_gain: \forall integer q, r, s, a, r2, s2; ends_up(q, r, s, a, r2, s2) && is_closer(r, s) ==>
        is_gain(q, a, 2);
    lemma end_up_2: \forall integer q, r, s, a, r2, s2; ends_up(q, r, s, a, r2, s2) && is_closer(r, s) ==>
        is_closest(r2, s2);
    lemma end_up_1: \forall integer q, r, s, a, r2, s2; ends_up(q, r, s, a, r2, s2) && is_closest(r, s) ==>
        r2 == r - s + a && s2 == s - 2 * a && r2 <= 0;
    lemma end_down_4_gain: \forall integer q, r, s, b, r2, s2; ends_down(q, r, s, b, r2, s2) ==> is_gain(q, b, 4);
    lemma end_down_2_gain: \forall integer q, r, s, b, r2, s2; ends_down(q, r, s, b, r2, s2) && is_closer(r, s) ==>
        is_gain(q, b, 2);
    lemma end_down_4: \forall integer q, r, s, b, r2, s2; ends_down(q, r, s, b, r2, s2) ==>
        s <= s2 <= 2 * s && s2 <= s + 0x800000000000 && is_closer(r2, s2);
    lemma end_down_2: \forall integer q, r, s, b, r2, s2; ends_down(q, r, s, b, r2, s2) && is_closer(r, s) ==>
        is_closest(r2, s2);
    lemma end_down_1: \forall integer q, r, s, b, r2, s2; ends_down(q, r, s, b, r2, s2) && is_closest(r, s) ==>
        r2 == r - s - b && s2 == s + 2 * b && r2 <= 0;
*/
/* Half a tick before a whole step one tick earlier is half a tick behind it. */
/*@ lemma tick_before: \forall integer r, s, a; 0 <= s && 0 <= s - 2 * a && s - s / 2 < r && r - s + a <= 0 ==>
        is_near(r - s + a, s - 2 * a);
    lemma tick_behind: \forall integer r, s, a; 0 <= s && 0 <= s - 2 * a && s / 2 < r && r - s + a <= 0 ==>
        is_near(-(r - s + a), s - 2 * a);
    lemma up_positive: \forall integer q, r, s, a, r2, s2; ends_up(q, r, s, a, r2, s2) ==> 0 <= s2;
    lemma up_near: \forall integer q, r, s, a, r2, s2; ends_up(q, r, s, a, r2, s2) && is_closest(r, s) ==>
        (s - s / 2 < r ==> is_near(r2, s2)) && (s / 2 < r ==> is_near(-r2, s2));
    lemma down_near: \forall integer q, r, s, b, r2, s2; ends_down(q, r, s, b, r2, s2) && is_closest(r, s) ==>
        (s - s / 2 < r ==> is_near(r2, s2)) && (s / 2 < r ==> is_near(-r2, s2));
*/
/*@ lemma up_guess: \forall integer q, r, s, a, r2, s2; is_guess(r, s, a) && ends_up(q, r, s, a, r2, s2) ==>
        is_guess(r2, s2, a);
    lemma down_guess: \forall integer q, r, s, b, r2, s2; is_guess(r, s, -b) && ends_down(q, r, s, b, r2, s2) ==>
        is_guess(r2, s2, -b);
*/
/* What a correction achieves. */
/*@ predicate approaches(integer r, integer s, integer a, integer r2, integer s2) =
        is_guess(r2, s2, a) && s2 <= s + 0x800000000000 && is_tame(r2, s2, a) &&
        (is_tame(r, s, a) ==> 2 * r2 <= r && -(2 * r2) <= r);
    predicate arrives(integer r, integer s, integer a, integer r2, integer s2) =
        is_guess(r2, s2, a) && s2 <= s + 0x800000000000 &&
        is_closer(r2, s2) && (is_closer(r, s) ==> is_closest(r2, s2));
    predicate ends_near(integer r, integer s, integer r2, integer s2) =
        (s - s / 2 < r ==> is_near(r2, s2)) && (s / 2 < r ==> is_near(-r2, s2));
    predicate corrects(integer q, integer r, integer s, integer a, integer r2, integer s2) =
        s < 0x400000000000000 && is_guess(r, s, a) && is_quotient(q, r, s) && is_corrected(q, r, s, a, r2, s2);

    lemma rises: \forall integer q, r, s, a, r2, s2; 0 <= a && is_beyond(r, s) &&
        corrects(q, r, s, a, r2, s2) ==> approaches(r, s, a, r2, s2);
    lemma rises_up: \forall integer q, r, s, a, r2, s2; 0 <= a && s <= 2 * r && is_close(r, s) &&
        corrects(q, r, s, a, r2, s2) ==> ends_up(q, r, s, a, r2, s2);
    lemma rises_close: \forall integer q, r, s, a, r2, s2; 0 <= a && s <= 2 * r && is_close(r, s) &&
        corrects(q, r, s, a, r2, s2) ==> arrives(r, s, a, r2, s2) &&
            (is_closest(r, s) ==> ends_near(r, s, r2, s2));
    predicate is_opposite(integer a, integer b) = a + b == 0;
    predicate falls(integer q, integer r, integer s, integer a, integer b, integer r2, integer s2) =
        is_opposite(a, b) && 0 <= b && corrects(q, r, s, a, r2, s2);
    lemma falls_sinks: \forall integer q, r, s, a, b, r2, s2; falls(q, r, s, a, b, r2, s2) && is_beyond(r, s) ==>
        sinks(q, r, s, b, r2, s2);
    lemma falls_flat: \forall integer r, s, a, b; is_opposite(a, b) ==> (is_tame(r, s, a) <==> is_flat(r, s, b));
    lemma falls_guess: \forall integer q, r, s, a, b, r2, s2; is_opposite(a, b) && sinks(q, r, s, b, r2, s2) ==>
        is_guess(r2, s2, a) && is_tame(r2, s2, a);
    lemma falls_far: \forall integer q, r, s, a, b, r2, s2; falls(q, r, s, a, b, r2, s2) && is_beyond(r, s) ==>
        approaches(r, s, a, r2, s2);
    lemma falls_down: \forall integer q, r, s, a, b, r2, s2; falls(q, r, s, a, b, r2, s2) && s <= 2 * r &&
        is_close(r, s) ==> ends_down(q, r, s, b, r2, s2);
    lemma falls_close_guess: \forall integer q, r, s, a, b, r2, s2; falls(q, r, s, a, b, r2, s2) &&
        ends_down(q, r, s, b, r2, s2) ==> is_guess(r2, s2, a);
    lemma falls_close: \forall integer q, r, s, a, b, r2, s2; falls(q, r, s, a, b, r2, s2) && s <= 2 * r &&
        is_close(r, s) ==> arrives(r, s, a, r2, s2) && (is_closest(r, s) ==> ends_near(r, s, r2, s2));
*/
#endif
