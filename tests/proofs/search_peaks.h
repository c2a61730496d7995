/*
 * The interval before a pulse of a braking ramp may have been one in which the motor still sped up. Then it was no
 * longer than the one to come, but for two ticks: what is predicted from it is not late. Whole numbers.
 */
#ifndef SEARCH_PEAKS_H
#define SEARCH_PEAKS_H

/* Products: v is the slope halfway through an interval of j ticks, g the way to the next pulse. */
/*@ logic integer peak(integer s, integer v, integer b, integer g) = s * v - 2 * (b * g);
    lemma peak_form: \forall integer s, b, j, g;
        peak(s, s - b * j, b, g) * peak(s, s - b * j, b, g) -
            (s - b * j) * (s - b * j) * (s * s - 4 * (b * g)) ==
                4 * (b * (g * (b * (g - j * (s - b * j)))));
    predicate is_halfway(integer s, integer b, integer j, integer v) = v == s - b * j;
    predicate is_peak_form(integer s, integer b, integer j, integer g, integer v) =
        peak(s, v, b, g) * peak(s, v, b, g) - v * v * (s * s - 4 * (b * g)) ==
            4 * (b * (g * (b * (g - j * v))));
    lemma peak_formed: \forall integer s, b, j, g, v; is_halfway(s, b, j, v) ==> is_peak_form(s, b, j, g, v);
    lemma peak_sign: \forall integer b, g, rest; 0 <= b && 0 <= g && 0 <= rest ==> 0 <= b * (g * (b * rest));
    logic integer slower(integer v, integer b) = v - 2 * b - 0x80000000;
    lemma peak_left_form: \forall integer s, b, t, v; (s - 2 * (b * t)) * slower(v, b) ==
        s * v - 2 * (s * b) - 0x80000000 * s - 2 * (t * slower(v, b)) * b;
    predicate is_less_turned(integer x, integer y, integer z) = z * x <= z * y;
    predicate is_scaled_square(integer v, integer u) = v * u * (v * u) == v * v * (u * u);
    lemma peak_scaled_square: \forall integer v, u; is_scaled_square(v, u);
*/
#include "search_ramps.h"

/*@ predicate is_no_longer(integer i, integer r, integer s, integer b) =
        2 <= i <= 0x40000000 && 2 * (b * i) <= s && (i - 2) * (s - b * (i - 2)) <= STEP_QUANTA - r;
    predicate is_over_peak(integer r, integer s, integer b, integer i, integer j, integer v, integer g) =
        is_braking(r, s, b) && is_no_longer(i, r, s, b) && j == i - 2 && is_halfway(s, b, j, v) &&
        g == STEP_QUANTA - r;
    predicate is_peak_slope(integer u, integer s, integer b, integer g) =
        21000000000 <= u && u * u <= s * s - 4 * (b * g);
    lemma peak_steps: \forall integer b, i, j; j == i - 2 ==> b * j == b * i - 2 * b && b * j == b * (i - 2);
    lemma peak_ticks: \forall integer s, b, i, j, v; j == i - 2 && v == s - b * (i - 2) ==>
        j * v == (i - 2) * (s - b * (i - 2));
    lemma peak_halfway: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        v == s - b * (i - 2) && v == s - b * i + 2 * b;
    lemma peak_way: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        0 <= j && j * v <= g;
    lemma peak_way_range: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        0 <= g <= STEP_QUANTA + s;
    lemma peak_half: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        s + 4 * b <= 2 * v && v <= s && 21000000000 <= s;
    lemma peak_least: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        is_peak_slope(21000000000, s, b, g);
    lemma peak_rest: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        0 <= b * (g * (b * (g - j * v)));
    lemma peak_form_at: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        is_peak_form(s, b, j, g, v);
    lemma peak_square: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        v * v * (s * s - 4 * (b * g)) <= peak(s, v, b, g) * peak(s, v, b, g);
    lemma turned: \forall integer x, y, z; is_less_scaled(x, y, z) ==> is_less_turned(x, y, z);
    lemma peak_slope_scaled: \forall integer u, r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) &&
        is_peak_slope(u, s, b, g) ==> is_less_scaled(u * u, s * s - 4 * (b * g), v * v);
    lemma peak_slope_less: \forall integer u, r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) &&
        is_peak_slope(u, s, b, g) ==> is_less_turned(u * u, s * s - 4 * (b * g), v * v);
    lemma peak_slope_known: \forall integer u, r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) &&
        is_peak_slope(u, s, b, g) ==> is_scaled_square(v, u);
    predicate is_at_most_scaled(integer z, integer x, integer d) = z * x <= d * d;
    lemma peak_at_most: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        is_at_most_scaled(v * v, s * s - 4 * (b * g), peak(s, v, b, g));
    lemma at_most_turned: \forall integer x, y, z, d; is_less_turned(x, y, z) && is_at_most_scaled(z, y, d) ==>
        is_at_most_scaled(z, x, d);
    lemma peak_slope_most: \forall integer u, r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) &&
        is_peak_slope(u, s, b, g) ==> is_at_most_scaled(v * v, u * u, peak(s, v, b, g));
    lemma at_most_scaled: \forall integer u, v, d; is_scaled_square(v, u) && is_at_most_scaled(v * v, u * u, d) ==>
        is_less_squared(v * u, d);
    lemma peak_slope_square: \forall integer u, r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) &&
        is_peak_slope(u, s, b, g) ==> is_less_squared(v * u, peak(s, v, b, g));
    lemma peak_half_scaled: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        is_less_scaled(s, 2 * v, s);
    lemma peak_positive: \forall integer u, r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) &&
        is_peak_slope(u, s, b, g) ==> 0 <= peak(s, v, b, g) && 0 <= v * u;
    lemma peak_ahead: \forall integer u, r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) &&
        is_peak_slope(u, s, b, g) ==> v * u <= peak(s, v, b, g);
*/
/* What is predicted: t ticks, at a slope w a little below that halfway. */
/*@ predicate predicts_peak(integer r, integer s, integer b, integer i, integer j, integer v, integer g, integer t,
        integer w) = is_over_peak(r, s, b, i, j, v, g) && w == slower(v, b) && is_predicted(t, r, s - b * i);
    lemma peak_slower: \forall integer r, s, b, i, j, v, g, t, w; predicts_peak(r, s, b, i, j, v, g, t, w) ==>
        w == s - b * i - 0x80000000 && t * w <= g + (s - b * i) / 2 + 0x200000000;
    lemma peak_predicted: \forall integer r, s, b, i, j, v, g, t, w; predicts_peak(r, s, b, i, j, v, g, t, w) ==>
        2 * (t * w) <= 2 * g + v + 0x400000000 && 1 <= w && w <= v && 0 <= t;
    lemma peak_scaled: \forall integer r, s, b, i, j, v, g, t, w; predicts_peak(r, s, b, i, j, v, g, t, w) ==>
        is_less_scaled(2 * (t * w), 2 * g + v + 0x400000000, b);
    lemma peak_left: \forall integer r, s, b, i, j, v, g, t, w; predicts_peak(r, s, b, i, j, v, g, t, w) ==>
        peak(s, v, b, g) - 2 * (s * b) - 0x80000000 * s - b * v - 0x400000000 * b <= (s - 2 * (b * t)) * w;
    lemma peak_accel_scaled: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        is_less_scaled(s, 2 * v, b) && is_less_scaled(b, 1024000000, v) && 500 * b <= v;
    lemma peak_enough: \forall integer u, r, s, b, i, j, v, g, t, w; predicts_peak(r, s, b, i, j, v, g, t, w) &&
        is_peak_slope(u, s, b, g) ==> v * (u - 9450000000) <= (s - 2 * (b * t)) * w;
    lemma peak_enough_scaled: \forall integer u, v; 21000000000 <= u && 0 <= v ==>
        is_less_scaled(11 * u, 20 * (u - 9450000000), v);
    lemma peak_slower_scaled: \forall integer u, r, s, b, i, j, v, g, t, w;
        predicts_peak(r, s, b, i, j, v, g, t, w) && is_peak_slope(u, s, b, g) ==> is_less_scaled(w, v, 11 * u);
    lemma peak_divided: \forall integer u, r, s, b, i, j, v, g, t, w; predicts_peak(r, s, b, i, j, v, g, t, w) &&
        is_peak_slope(u, s, b, g) ==> is_less_scaled(11 * u, 20 * (s - 2 * (b * t)), w);
    lemma peak_slope: \forall integer u, r, s, b, i, j, v, g, t, w; predicts_peak(r, s, b, i, j, v, g, t, w) &&
        is_peak_slope(u, s, b, g) ==> 40 * (b * t) <= 20 * s - 11 * u;
*/
/* How late it may be. */
/*@ lemma peak_end_form: \forall integer s, b, j; (s - 2 * (b * j)) * (s - 2 * (b * j)) ==
        s * s - 4 * (b * (j * (s - b * j)));
    lemma peak_end_scaled: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        is_less_scaled(j * v, g, b);
    lemma peak_end_square: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        is_less_squared(21000000000, s - 2 * (b * j));
    lemma peak_end: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        21000000000 <= s - 2 * (b * j);
    lemma peak_speed: \forall integer r, s, b, i, j, v, g, t, w; predicts_peak(r, s, b, i, j, v, g, t, w) ==>
        s <= 2 * w && 18000000000 <= w && w <= s;
    lemma peak_soon_scaled: \forall integer r, s, b, i, j, v, g, t, w; predicts_peak(r, s, b, i, j, v, g, t, w) &&
        4 <= t ==> is_less_scaled(18000000000, w, t - 4);
    lemma peak_soon: \forall integer r, s, b, i, j, v, g, t, w; predicts_peak(r, s, b, i, j, v, g, t, w) ==>
        t <= 101000000;
    lemma peak_before_scaled: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        is_less_scaled(b * j, v, j);
    lemma peak_before: \forall integer r, s, b, i, j, v, g; is_over_peak(r, s, b, i, j, v, g) ==>
        b * i * i <= g + 2 * s + 4 * b;
*/
#endif
