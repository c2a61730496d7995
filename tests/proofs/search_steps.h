/*
 * How a search converges: one correction of the search for a pulse, in whole numbers that do not wrap.
 *
 * Along a parabola slope^2 - 4*accel*residual stays as it is: it is the square of the slope at the whole step. What is
 * shown is for a residual above 0; the other is its mirror image, with the acceleration's sign changed.
 */
#ifndef SEARCH_STEPS_H
#define SEARCH_STEPS_H

#include "search_quotients.h"

/*@ predicate is_corrected(integer q, integer r, integer s, integer a, integer r2, integer s2) =
        r2 == r - q * s + a * q * q && s2 == s - 2 * a * q;
*/

/*@ lemma same_parabola: \forall integer q, r, s, a; curve(r - q * s + a * q * q, s - 2 * a * q, a) == curve(r, s, a);
    lemma corrected_curve: \forall integer q, r, s, a, r2, s2; is_corrected(q, r, s, a, r2, s2) ==>
        curve(r2, s2, a) == curve(r - q * s + a * q * q, s - 2 * a * q, a);
    lemma same_curve: \forall integer q, r, s, a, r2, s2; is_corrected(q, r, s, a, r2, s2) ==>
        curve(r2, s2, a) == curve(r, s, a);
*/
/* The slope at a whole step. */
/*@ lemma rising_square: \forall integer r, s, a; 0 <= a && 0 <= r && is_crossing(r, s, a) ==>
        21000000000 * 21000000000 <= s * s;
    lemma rising_slope: \forall integer r, s, a; 0 < s && 0 <= a && 0 <= r && is_crossing(r, s, a) ==>
        21000000000 <= s;
    lemma tame_square: \forall integer r, s, a; is_tame(r, s, a) && is_crossing(r, s, a) ==>
        0x400000000 * 0x400000000 <= s * s;
    lemma tame_slope: \forall integer r, s, a; 0 < s && is_tame(r, s, a) && is_crossing(r, s, a) ==>
        0x400000000 <= s;
    lemma tame_mirror: \forall integer r, s, a; is_tame(-r, s, -a) <==> is_tame(r, s, a);
    lemma guess_mirror: \forall integer r, s, a; is_guess(-r, s, -a) <==> is_guess(r, s, a);
*/

/* On the side of the less steep slope: b is the acceleration's size. Wild: after a guess; else the search goes on. */
/*@ predicate is_sunk(integer q, integer r, integer s, integer b, integer r2, integer s2) =
        r2 == r - q * s - b * q * q && s2 == s + 2 * (b * q);
    predicate is_flat(integer r, integer s, integer b) = 9 * (b * r) <= s * s;
    predicate is_wild(integer q, integer r, integer s, integer b) =
        0 <= b && is_guess(r, s, -b) && is_beyond(r, s) && is_quotient(q, r, s);
    predicate is_sinking(integer q, integer r, integer s, integer b) = is_wild(q, r, s, b) && is_flat(r, s, b);
    lemma sunk: \forall integer q, r, s, b, r2, s2; is_corrected(q, r, s, -b, r2, s2) <==> is_sunk(q, r, s, b, r2, s2);
    lemma flat: \forall integer r, s, b; is_tame(r, s, -b) <==> is_flat(r, s, b);
    lemma sunk_square: \forall integer q, r, s, b, r2, s2; is_sunk(q, r, s, b, r2, s2) ==>
        s2 * s2 == s * s + 4 * (b * (q * s)) + 4 * ((b * q) * (b * q));
    lemma flat_before: \forall integer r, s, b; 0 <= b && r <= 0 ==> is_flat(r, s, b);
*/
/* No slope grows far. */
/*@ predicate is_far(integer r, integer s, integer b) =
        0 <= b <= 0x40000000 && 0 <= r && 0 < s && b * r * r <= 0x800000000000000 * (s * s);
    lemma far: \forall integer r, s, b; 0 <= b && 0 <= r && is_guess(r, s, -b) ==> is_far(r, s, b);
    lemma growth_square: \forall integer r, s, b; is_far(r, s, b) ==>
        (b * r) * (b * r) <= (0x800000000000000 * b) * (s * s);
    lemma growth_bound: \forall integer r, s, b; is_far(r, s, b) ==>
        (0x800000000000000 * b) * (s * s) <= (0x800000000000000 * 0x40000000) * (s * s);
    lemma growth_root: \forall integer r, s, b; is_far(r, s, b) ==> is_less_squared(b * r, 0x200000000000 * s);
    lemma growth_product: \forall integer r, s, b; is_far(r, s, b) ==> b * r <= 0x200000000000 * s;
*/
/*@ lemma wild_accel_slope: \forall integer q, r, s, b; is_wild(q, r, s, b) ==> 10 * (b * s) <= s * s;
    lemma wild_way: \forall integer q, r, s, b; is_wild(q, r, s, b) ==> 3 * r <= 4 * (q * s) && 4 * (q * s) <= 5 * r;
    lemma wild_way_least: \forall integer q, r, s, b; is_wild(q, r, s, b) ==> is_less_scaled(3 * r, 4 * (q * s), b);
    lemma wild_way_most: \forall integer q, r, s, b; is_wild(q, r, s, b) ==> is_less_scaled(4 * (q * s), 5 * r, b);
    lemma wild_way_square: \forall integer q, r, s, b; is_wild(q, r, s, b) ==> is_less_squared(4 * (q * s), 5 * r);
    lemma wild_way_reach: \forall integer q, r, s, b; is_wild(q, r, s, b) ==>
        (4 * (q * s)) * (4 * (q * s)) * b <= (5 * r) * (5 * r) * b;
    lemma wild_gain_scaled: \forall integer q, r, s, b; is_wild(q, r, s, b) ==>
        (16 * (b * q * q)) * (s * s) <= (25 * 0x800000000000000) * (s * s);
    lemma wild_gain_way: \forall integer q, r, s, b; is_wild(q, r, s, b) ==>
        16 * (b * q * q) <= 25 * 0x800000000000000;
    lemma wild_far: \forall integer q, r, s, b; is_wild(q, r, s, b) ==> is_far(r, s, b);
    lemma wild_product: \forall integer q, r, s, b; is_wild(q, r, s, b) ==> b * r <= 0x200000000000 * s;
    lemma wild_product_way: \forall integer q, r, s, b; is_wild(q, r, s, b) ==> 4 * ((b * q) * s) <= 5 * (b * r);
    lemma growth_scaled: \forall integer q, r, s, b; is_wild(q, r, s, b) ==>
        (4 * (b * q)) * s <= (5 * 0x200000000000) * s;
    lemma growth_gain: \forall integer q, r, s, b; is_wild(q, r, s, b) ==> 4 * (b * q) <= 5 * 0x200000000000;
*/
/*@ predicate sinks(integer q, integer r, integer s, integer b, integer r2, integer s2) =
        is_wild(q, r, s, b) && is_sunk(q, r, s, b, r2, s2);
    lemma wild_slope: \forall integer q, r, s, b, r2, s2; sinks(q, r, s, b, r2, s2) ==>
        s <= s2 <= s + 0x800000000000;
    lemma wild_residual: \forall integer q, r, s, b, r2, s2; sinks(q, r, s, b, r2, s2) ==>
        -0x2000000000000000 < r2 < 0x2000000000000000;
    lemma wild_slope_square: \forall integer q, r, s, b, r2, s2; sinks(q, r, s, b, r2, s2) ==>
        s * s + 3 * (b * r) <= s2 * s2;
    lemma wild_past_less: \forall integer q, r, s, b, r2, s2; sinks(q, r, s, b, r2, s2) ==> 8 * r2 <= 4 * s + r;
    lemma wild_past_rest: \forall integer q, r, s, b, r2, s2; sinks(q, r, s, b, r2, s2) ==>
        is_less_scaled(8 * r2, 4 * s + r, b);
    lemma wild_past: \forall integer q, r, s, b, r2, s2; sinks(q, r, s, b, r2, s2) ==> is_flat(r2, s2, b);
    lemma wild_tame: \forall integer q, r, s, b, r2, s2; sinks(q, r, s, b, r2, s2) ==> is_tame(r2, s2, -b);
    lemma wild_crossing: \forall integer q, r, s, b, r2, s2; sinks(q, r, s, b, r2, s2) ==> is_crossing(r2, s2, -b);
    lemma wild_guess: \forall integer q, r, s, b, r2, s2; sinks(q, r, s, b, r2, s2) ==> is_guess(r2, s2, -b);
*/
/*@ lemma sinking_steep: \forall integer q, r, s, b; is_sinking(q, r, s, b) ==> 0x400000000 <= s;
    lemma sinking_gain_product: \forall integer q, r, s, b; is_sinking(q, r, s, b) ==>
        is_less_scaled(14 * (q * s), 15 * r + 7 * s, b);
    lemma sinking_gain_scaled: \forall integer q, r, s, b; is_sinking(q, r, s, b) ==>
        (100 * (b * q)) * s <= (17 * s) * s;
    lemma sinking_gain: \forall integer q, r, s, b; is_sinking(q, r, s, b) ==> 100 * (b * q) <= 17 * s;
    lemma sinking_gain_way: \forall integer q, r, s, b; is_sinking(q, r, s, b) ==>
        100 * (b * q * q) <= 17 * (q * s);
    lemma sinking_near: \forall integer q, r, s, b, r2, s2; is_sinking(q, r, s, b) &&
        is_sunk(q, r, s, b, r2, s2) ==> 2 * r2 <= r && -(2 * r2) <= r;
*/
/* On the side of the steeper slope. */
/*@ predicate is_rising(integer q, integer r, integer s, integer a) =
        0 <= a && is_guess(r, s, a) && is_beyond(r, s) && is_quotient(q, r, s);
    lemma rising_scaled: \forall integer r, s, a; 0 <= a && 0 <= r && is_crossing(r, s, a) ==> 4 * (a * r) <= s * s;
    lemma rising_gain_product: \forall integer q, r, s, a; is_rising(q, r, s, a) ==>
        14 * (a * (q * s)) <= 15 * (a * r) + 7 * (a * s);
    lemma rising_accel_slope: \forall integer q, r, s, a; is_rising(q, r, s, a) ==> 20 * (a * s) <= s * s;
    lemma rising_gain_scaled: \forall integer q, r, s, a; is_rising(q, r, s, a) ==>
        (100 * (a * q)) * s <= (30 * s) * s;
    lemma rising_gain: \forall integer q, r, s, a; is_rising(q, r, s, a) ==> 10 * (a * q) <= 3 * s;
    lemma rising_gain_way: \forall integer q, r, s, a; is_rising(q, r, s, a) ==> 10 * (a * q * q) <= 3 * (q * s);
    lemma rising_near: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) ==> 2 * r2 <= r && -(2 * r2) <= r;
    lemma rising_next: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) ==> 2 * s <= 5 * s2 && s2 <= s;
*/
/*@ lemma rising_past_way: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> 56 * (a * q * q) <= 11 * (q * s);
    lemma rising_past_gain: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> 56 * (a * q) <= 11 * s;
    lemma rising_past_slope: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> 34 * s <= 56 * s2;
    lemma rising_past_square: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> is_less_squared(34 * s, 56 * s2);
    lemma rising_past_more: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> r <= q * s && 0 <= a * q * q;
    lemma rising_past_most: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> is_less_scaled(r, q * s, a);
    lemma rising_past_times: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> (56 * (a * q)) * s <= (11 * s) * s;
    lemma rising_past_product: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> 56 * (a * r) <= 11 * (s * s);
    lemma rising_past_less: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> 14 * -r2 <= 7 * s + r;
    lemma rising_past_rest: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> is_less_scaled(14 * -r2, 7 * s + r, a);
    lemma rising_past: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) && r2 < 0 ==> is_tame(r2, s2, a);
*/
/*@ lemma rising_tame: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) ==> is_tame(r2, s2, a);
    lemma tame_in_reach: \forall integer r, s, a; is_tame(r, s, a) && is_crossing(r, s, a) && 
        -0x2000000000000000 < r < 0x2000000000000000 ==> is_far_in_reach(r, s, a);
    lemma rising_guess: \forall integer q, r, s, a, r2, s2; is_rising(q, r, s, a) &&
        is_corrected(q, r, s, a, r2, s2) ==> is_guess(r2, s2, a);
*/

/*@ lemma sinking_halves: \forall integer q, r, s, b, r2, s2; sinks(q, r, s, b, r2, s2) && is_flat(r, s, b) ==>
        2 * r2 <= r && -(2 * r2) <= r;
*/
#endif
