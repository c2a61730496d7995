/*
 * The interval that is predicted where the motor brakes is a good guess for the search of the pulse. Whole numbers.
 */
#ifndef SEARCH_BRAKING_H
#define SEARCH_BRAKING_H

/* Products. */
/*@ logic integer squared(integer x) = x * x;
    lemma squared: \forall integer x; 0 <= squared(x);
    lemma form: \forall integer u, s; squared(968 * s - 1305 * u) + 232975 * squared(u) ==
        1936 * (484 * (s * s) + 1000 * (u * u) - 1305 * (u * s));
    predicate is_formed(integer u, integer s) = 1305 * (u * s) <= 484 * (s * s) + 1000 * (u * u);
    lemma formed: \forall integer u, s; is_formed(u, s);
    lemma spread: \forall integer i, t; squared(i - 2 * t) == i * i - 4 * (t * (i - t));
    lemma spread_least: \forall integer i, t; 0 <= i * i - 4 * (t * (i - t));
    predicate is_spread(integer b, integer i, integer t) = 4 * (b * (t * (i - t))) <= b * i * i;
    lemma spread_scaled: \forall integer b, i, t; 0 <= b ==> 0 <= b * (i * i - 4 * (t * (i - t)));
    lemma spread_all: \forall integer b, i, t; 0 <= b ==> is_spread(b, i, t);
    predicate is_brake_moved(integer x, integer s, integer b, integer t, integer r2, integer s2) =
        r2 == x + t * s - (b * t) * t && s2 == s - 2 * (b * t);
    logic integer brake_square(integer x, integer s, integer b) = s * s + 4 * b * x;
    lemma brake_parabola: \forall integer x, s, b, t;
        brake_square(x + t * s - (b * t) * t, s - 2 * (b * t), b) == brake_square(x, s, b);
    lemma brake_moves: \forall integer x, s, b, t, r2, s2; is_brake_moved(x, s, b, t, r2, s2) ==>
        brake_square(r2, s2, b) == brake_square(x + t * s - (b * t) * t, s - 2 * (b * t), b);
    lemma brake_moved: \forall integer x, s, b, t, r2, s2; is_brake_moved(x, s, b, t, r2, s2) ==>
        brake_square(r2, s2, b) == brake_square(x, s, b);
    predicate is_slower(integer w, integer s, integer b, integer i) = w == s - b * i - 0x80000000;
    lemma brake_way: \forall integer s, b, i, t;
        t * s - (b * t) * t == t * (s - b * i - 0x80000000) + b * (t * (i - t)) + 0x80000000 * t;
    predicate is_split(integer w, integer s, integer b, integer i, integer t) =
        t * s - (b * t) * t == t * w + b * (t * (i - t)) + 0x80000000 * t;
    lemma brake_way_slower: \forall integer w, s, b, i, t; is_slower(w, s, b, i) ==> is_split(w, s, b, i, t);
*/
#include "search_peaks.h"

/* Braking: the interval before was not much longer than a step's time at the slope that is left, or no longer than the
 * next; w is the slope by which the next is predicted, half a unit of the high word lower. */
/*@ predicate is_interval_before(integer i, integer s, integer b) =
        0 <= i <= 0x40000000 && 4 * (i * s) <= 5 * STEP_QUANTA && 4 * (b * i) <= s + 10 * b;
    predicate is_told(integer r, integer s, integer b, integer i, integer t, integer w) =
        is_braking(r, s, b) && 0 <= i && is_slower(w, s, b, i) && is_predicted(t, r, s - b * i);
    lemma told_less: \forall integer r, s, b, i, t, w; is_told(r, s, b, i, t, w) ==> 0 <= b * i && 0 <= b * t;
    lemma told_predicted: \forall integer r, s, b, i, t, w; is_told(r, s, b, i, t, w) ==>
        t * w <= STEP_QUANTA - r + (s - b * i) / 2 + 0x200000000;
    lemma told_way: \forall integer r, s, b, i, t, w; is_told(r, s, b, i, t, w) ==> t * w <= STEP_QUANTA + 2 * s;
    predicate is_before(integer i, integer r, integer s, integer b) =
        is_interval_before(i, s, b) || is_no_longer(i, r, s, b);
    predicate brakes(integer r, integer s, integer b, integer i, integer t, integer w) =
        is_told(r, s, b, i, t, w) && is_before(i, r, s, b);
    lemma brakes_over_peak: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) &&
        is_no_longer(i, r, s, b) ==>
            predicts_peak(r, s, b, i, i - 2, s - b * (i - 2), STEP_QUANTA - r, t, w);
    lemma brakes_before_speed: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) &&
        is_interval_before(i, s, b) ==> 4 * w >= 3 * s - 10 * b - 0x200000000 && 2 * w >= s && w <= s;
    lemma brakes_speed: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) ==> 2 * w >= s && w <= s;
    lemma brakes_way: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) ==>
        t * w <= STEP_QUANTA + 2 * s;
    lemma brakes_way_scaled: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) ==>
        is_less_scaled(t * w, STEP_QUANTA + 2 * s, b);
    predicate is_slope_ahead(integer u, integer r, integer s, integer b) = 21000000000 <= u &&
        u * u <= s * s + 4 * (b * r) - 4 * (b * STEP_QUANTA);
    lemma ahead_square: \forall integer u, r, s, b; is_braking(r, s, b) && is_slope_ahead(u, r, s, b) ==>
        4 * (b * STEP_QUANTA) + u * u <= s * s + 2 * (b * s) + 2 * b;
    lemma ahead_less_squared: \forall integer u, r, s, b; is_braking(r, s, b) && is_slope_ahead(u, r, s, b) ==>
        is_less_squared(u, s);
    lemma ahead_less: \forall integer u, r, s, b; is_braking(r, s, b) && is_slope_ahead(u, r, s, b) ==> u <= s;
    predicate brakes_to(integer u, integer r, integer s, integer b, integer i, integer t, integer w) =
        brakes(r, s, b, i, t, w) && is_slope_ahead(u, r, s, b);
    lemma ahead_needs: \forall integer u, r, s, b, i, t, w; brakes_to(u, r, s, b, i, t, w) ==>
        (40 * (b * t)) * w <= 10 * (s * s) - 10 * (u * u) + 100 * (b * s) + 20 * b;
    lemma ahead_has_slope: \forall integer u, r, s, b, i, t, w; brakes_to(u, r, s, b, i, t, w) &&
        is_interval_before(i, s, b) ==>
        is_less_scaled(3 * s - 10 * b - 0x200000000, 4 * w, s);
    lemma ahead_has_less: \forall integer u, r, s, b, i, t, w; brakes_to(u, r, s, b, i, t, w) ==>
        is_less_scaled(w, s, u);
    lemma ahead_has: \forall integer u, r, s, b, i, t, w; brakes_to(u, r, s, b, i, t, w) &&
        is_interval_before(i, s, b) ==>
        15 * (s * s) - 50 * (b * s) - 0x200000000 * (5 * s) - 11 * (u * s) <= (20 * s - 11 * u) * w;
    lemma ahead_unit: \forall integer u, s; 21000000000 <= u && 0 < s ==>
        is_less_scaled(0x200000000 * 100, 41 * u, s);
    lemma ahead_accel: \forall integer r, s, b; is_braking(r, s, b) ==> is_less_scaled(1000 * b, s, s);
    lemma ahead_products: \forall integer u, r, s, b; is_slope_ahead(u, r, s, b) ==> is_formed(u, s);
    lemma ahead_little: \forall integer r, s, b; is_braking(r, s, b) ==> 100 * (150 * (b * s) + 20 * b) <= 16 * (s * s);
    lemma ahead_left: \forall integer u, r, s, b; is_braking(r, s, b) && is_slope_ahead(u, r, s, b) ==>
        100 * (0x200000000 * (5 * s)) <= 205 * (u * s);
    lemma ahead_enough: \forall integer u, r, s, b; is_braking(r, s, b) && is_slope_ahead(u, r, s, b) ==>
        10 * (s * s) - 10 * (u * u) + 100 * (b * s) + 20 * b <=
            15 * (s * s) - 50 * (b * s) - 0x200000000 * (5 * s) - 11 * (u * s);
    lemma ahead_divided: \forall integer u, r, s, b, i, t, w; brakes_to(u, r, s, b, i, t, w) &&
        is_interval_before(i, s, b) ==>
        is_less_scaled(40 * (b * t), 20 * s - 11 * u, w);
    lemma ahead_before: \forall integer u, r, s, b, i, t, w; brakes_to(u, r, s, b, i, t, w) &&
        is_interval_before(i, s, b) ==> 40 * (b * t) <= 20 * s - 11 * u;
    lemma ahead_is_peak: \forall integer u, r, s, b; is_slope_ahead(u, r, s, b) ==>
        is_peak_slope(u, s, b, STEP_QUANTA - r);
    lemma ahead_over_peak: \forall integer u, r, s, b, i, t, w; brakes_to(u, r, s, b, i, t, w) &&
        is_no_longer(i, r, s, b) ==> 40 * (b * t) <= 20 * s - 11 * u;
    lemma ahead: \forall integer u, r, s, b, i, t, w; brakes_to(u, r, s, b, i, t, w) ==>
        40 * (b * t) <= 20 * s - 11 * u;
*/
/* What is guessed: residual r2 and slope s2 then. */
/*@ predicate guesses_brake(integer r, integer s, integer b, integer i, integer t, integer w, integer r2, integer s2) =
        brakes(r, s, b, i, t, w) && is_brake_moved(r - STEP_QUANTA, s, b, t, r2, s2);
    lemma braked_least: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        brakes_to(21000000000, r, s, b, i, t, w);
    lemma brakes_later: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) ==> 0 <= b * t;
    lemma braked_slope: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        11550000000 <= s2 <= s;
    lemma braked_curve_same: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        s2 * s2 + 4 * b * r2 == s * s + 4 * b * (r - STEP_QUANTA);
    lemma braked_not_ahead: \forall integer u, r, s, b, i, t, w, r2, s2;
        guesses_brake(r, s, b, i, t, w, r2, s2) && u == 2 * s2 ==> !brakes_to(u, r, s, b, i, t, w);
    lemma braked_ahead: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        !is_slope_ahead(2 * s2, r, s, b);
    lemma braked_curve: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        4 * (b * r2) <= 3 * (s2 * s2);
    lemma braked_curve_least: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        -(4 * (b * r2)) <= s2 * s2;
    lemma braked_way: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        is_less_scaled(0, s - b * t, t);
    lemma braked_behind: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        r - STEP_QUANTA <= r2;
    lemma braked_unit_scaled: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) ==>
        is_less_scaled(s, 2 * w, t);
    lemma braked_unit_least: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) ==>
        is_less_scaled(21000000000, s, t);
    lemma braked_unit: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) ==>
        0x80000000 * (4 * t) <= STEP_QUANTA;
    lemma braked_spread: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) ==> is_spread(b, i, t);
    lemma braked_before_scaled: \forall integer i, s, b; 0 <= s && is_interval_before(i, s, b) ==>
        is_less_scaled(4 * (b * i), s + 10 * b, 4 * (i * s));
    lemma braked_before_more: \forall integer i, s, b; 0 <= s && 0 <= b && is_interval_before(i, s, b) ==>
        is_less_scaled(4 * (i * s), 5 * STEP_QUANTA, s + 10 * b);
    lemma braked_before_all: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) &&
        is_interval_before(i, s, b) ==>
        is_less_scaled(16 * (b * i * i), 6 * STEP_QUANTA, s);
    lemma braked_before: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) &&
        is_interval_before(i, s, b) ==>
        16 * (b * i * i) <= 6 * STEP_QUANTA;
    lemma braked_split: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) ==> is_split(w, s, b, i, t);
    lemma braked_past_way: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        r2 == r - STEP_QUANTA + t * w + b * (t * (i - t)) + 0x80000000 * t;
    lemma braked_past_before: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) &&
        is_interval_before(i, s, b) ==> 5 * r2 <= 2 * STEP_QUANTA;
    lemma braked_over_peak: \forall integer r, s, b, i, t, w; brakes(r, s, b, i, t, w) && is_no_longer(i, r, s, b) ==>
        4 * (b * (t * (i - t))) <= STEP_QUANTA + 3 * s && 0x80000000 * t <= 217000000000000000 &&
        2 * (t * w) <= 2 * (STEP_QUANTA - r) + s + 0x400000000;
    lemma braked_past_peak: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) &&
        is_no_longer(i, r, s, b) ==> 5 * r2 <= 2 * STEP_QUANTA;
    lemma braked_past: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        5 * r2 <= 2 * STEP_QUANTA;
    lemma braked_far_ahead: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) &&
        0 <= r2 ==> is_less_scaled(4 * (b * r2), 3 * (s2 * s2), r2);
    lemma braked_far_behind: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) &&
        r2 <= 0 ==> is_less_scaled(-(4 * (b * r2)), s2 * s2, -r2);
    lemma braked_size: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        is_less_scaled(5 * r2, 2 * STEP_QUANTA, s2 * s2) && is_less_scaled(-r2, 0x2000000000000000, s2 * s2);
    lemma braked_far: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        b * r2 * r2 <= 0x800000000000000 * (s2 * s2);
    lemma braked_guess: \forall integer r, s, b, i, t, w, r2, s2; guesses_brake(r, s, b, i, t, w, r2, s2) ==>
        is_guess(r2, s2, -b);
*/
#endif
