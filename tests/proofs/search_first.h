/*
 * The time of a segment's first pulse is a good guess for its search, whether it is told from the way at the slope of
 * the beginning or from the slope at the pulse. Whole numbers that do not wrap.
 */
#ifndef SEARCH_FIRST_H
#define SEARCH_FIRST_H

#include "parabola.h"
#include "search_guesses.h"

/*@ predicate is_product_sized(integer p, integer r) = p * r <= size(p) * size(r) && -(p * r) <= size(p) * size(r);
    lemma product_sized: \forall integer p, r; is_product_sized(p, r);
    lemma less_scaled_part: \forall integer x, y, z; 1 <= z && is_less_scaled(x, y, z) ==> x <= y;
    predicate is_eighth(integer g, integer s) = 64 * (g * g) <= s * s;
    lemma eighth_factors: \forall integer g, s; -s <= 8 * g <= s ==> 0 <= (s - 8 * g) * (s + 8 * g);
    lemma eighth: \forall integer g, s; -s <= 8 * g <= s ==> is_eighth(g, s);
    predicate is_part(integer a, integer y, integer s) = -(size(a) * s) <= a * y <= size(a) * s;
    lemma part_up: \forall integer a, y, s; 0 <= a && -s <= y <= 0 ==> -(a * s) <= a * y && a * y <= 0 && 0 <= a * s;
    lemma part_down: \forall integer a, y, s; a <= 0 && -s <= y <= 0 ==> 0 <= a * y && a * y <= -a * s;
    lemma part: \forall integer a, y, s; -s <= y <= 0 ==> is_part(a, y, s);
    predicate is_squared_back(integer u, integer a, integer s2) = u * u - 4 * (a * u) <= s2 * s2;
    lemma squared_back: \forall integer u, a; (u - 2 * a) * (u - 2 * a) == u * u - 4 * (a * u) + 4 * (a * a);
*/
/* Where the first pulse is searched from: x is missing to it, and below 0. */
/*@ predicate is_begun(integer x, integer s, integer a) = is_accel(a) && 21000000000 <= s <= 0x80000000000000 &&
        -(STEP_QUANTA + 2 * s) <= x <= 4 * s && is_crossing(x, s, a);
*/
/* At the slope of the beginning, which changes by a quarter at most until then. */
/*@ predicate is_first_way(integer x, integer s, integer a, integer t, integer r2, integer s2) =
        is_begun(x, s, a) && x <= 0 && 0 <= t && t * s <= -x < t * s + s && 8 * (size(a) * t) <= s &&
        is_gone(x, s, a, t, r2, s2);
    lemma way_gain: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        -s <= 8 * (a * t) <= s;
    lemma way_slope: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        3 * s <= 4 * s2 && 4 * s2 <= 5 * s;
    lemma way_gain_more: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        is_less_scaled(8 * (a * t), s, t) && is_less_scaled(-s, 8 * (a * t), t);
    lemma way_part: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        -s <= r2 - (a * t) * t <= 0;
    lemma way_past: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        size(r2) <= 0x400000000000000;
    lemma way_accel: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        20 * size(a) <= s;
    lemma way_accel_scaled: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        is_less_scaled(20 * size(a), s, s);
    lemma way_eighth: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==> is_eighth(a * t, s);
    lemma way_gain_square: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        64 * ((a * t) * (a * t)) <= s * s;
    lemma way_split: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        a * r2 == a * (r2 - (a * t) * t) + (a * t) * (a * t);
    lemma way_of_part: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        is_part(a, r2 - (a * t) * t, s);
    lemma way_product: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        8 * size(a * r2) <= s * s;
    lemma way_far_product: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        is_less_scaled(8 * size(a * r2), s * s, size(r2));
    lemma way_far_size: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        is_less_scaled(size(r2), 0x400000000000000, s * s);
    lemma way_slope_squared: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        is_less_squared(3 * s, 4 * s2);
    lemma way_far_sized: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        8 * (size(a * r2) * size(r2)) <= 0x400000000000000 * (s * s);
    lemma way_sized: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==>
        is_product_sized(a * r2, r2);
    lemma way_far: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==> is_far_in_reach(r2, s2, a);
    lemma way_crosses: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==> is_crossing(r2, s2, a);
    lemma way_guess: \forall integer x, s, a, t, r2, s2; is_first_way(x, s, a, t, r2, s2) ==> is_guess(r2, s2, a);
    lemma none_guess: \forall integer x, s, a; is_begun(x, s, a) && 0 <= x ==> is_guess(x, s, a);
*/
/* At the slope u of the pulse, the root of a square that is nearly that of the ramp there. */
/*@ predicate is_first_slope(integer u, integer x, integer s, integer a) = 20900000000 <= u <= 0x40000000000000 &&
        -(13 * u) <= u * u - bend(x, s, a) <= 13 * u;
    predicate is_first_speed(integer x, integer s, integer a, integer t, integer u, integer r2, integer s2) =
        is_begun(x, s, a) && is_first_slope(u, x, s, a) && 0 <= t && is_gone(x, s, a, t, r2, s2);
    predicate is_up(integer s, integer a, integer t, integer u) =
        128 <= a && 2 * (a * t) <= u - s < 2 * (a * t) + 2 * a;
    predicate is_down(integer s, integer a, integer t, integer u) =
        128 <= -a && -(2 * (a * t)) <= s - u < -(2 * (a * t)) - 2 * a;
    lemma up_slope: \forall integer x, s, a, t, u, r2, s2; is_up(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> u - 2 * a <= s2 <= u && 9 * u <= 10 * s2;
    lemma down_slope: \forall integer x, s, a, t, u, r2, s2; is_down(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> u <= s2 <= u - 2 * a && s2 <= s;
    lemma up_squared: \forall integer x, s, a, t, u, r2, s2; is_up(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> is_less_squared(u - 2 * a, s2) && is_less_squared(s2, u);
    lemma down_squared: \forall integer x, s, a, t, u, r2, s2; is_down(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> is_less_squared(s2, u - 2 * a) && is_less_squared(u, s2);
    lemma up_square: \forall integer x, s, a, t, u, r2, s2; is_up(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> u * u - 4 * (a * u) <= s2 * s2 <= u * u;
    lemma down_square: \forall integer x, s, a, t, u, r2, s2; is_down(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> u * u <= s2 * s2 <= u * u - 4 * (a * u) + 4 * (a * a);
    lemma least_scaled: \forall integer a, u; 128 <= a && 0 < u ==> is_less_scaled(128, a, u);
    lemma up_least: \forall integer s, a, t, u; is_up(s, a, t, u) && 0 < u ==> 128 * u <= a * u;
    lemma down_least_scaled: \forall integer s, a, t, u; is_down(s, a, t, u) && 0 < u ==> is_less_scaled(128, -a, u);
    lemma down_least: \forall integer s, a, t, u; is_down(s, a, t, u) && 0 < u ==> 128 * u <= -(a * u);
    lemma up_residual_scaled: \forall integer x, s, a, t, u, r2, s2; is_up(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==>
            is_less_scaled(2 * r2, 3 * u, a) && is_less_scaled(-(2 * r2), 3 * u, a);
    lemma down_accel: \forall integer x, s, a, t, u, r2, s2; is_down(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> is_less_scaled(-(20 * a), u, -a);
    lemma down_residual_scaled: \forall integer x, s, a, t, u, r2, s2; is_down(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==>
            is_less_scaled(2 * r2, 3 * u, -a) && is_less_scaled(-(2 * r2), 3 * u, -a);
    lemma up_residual: \forall integer x, s, a, t, u, r2, s2; is_up(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> 2 * size(r2) <= 3 * u;
    lemma down_residual: \forall integer x, s, a, t, u, r2, s2; is_down(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> 2 * size(r2) <= 3 * u;
    lemma up_close: \forall integer x, s, a, t, u, r2, s2; is_up(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> is_close(r2, s2);
    lemma down_close: \forall integer x, s, a, t, u, r2, s2; is_down(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> is_close(r2, s2);
    lemma speed_crosses: \forall integer x, s, a, t, u, r2, s2; is_first_speed(x, s, a, t, u, r2, s2) ==>
        is_crossing(r2, s2, a);
    lemma up_guess: \forall integer x, s, a, t, u, r2, s2; is_up(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> is_guess(r2, s2, a);
    lemma down_guess: \forall integer x, s, a, t, u, r2, s2; is_down(s, a, t, u) &&
        is_first_speed(x, s, a, t, u, r2, s2) ==> is_guess(r2, s2, a);
*/
#endif
