/*
 * The interval that is predicted where the motor speeds up is a good guess for the search of the pulse. Whole numbers.
 */
#ifndef SEARCH_SPEEDING_H
#define SEARCH_SPEEDING_H

#include "parabola.h"

/* Products. */
/*@ predicate is_squared_less(integer x, integer y) = x * x <= y * y;
    lemma squared_factors: \forall integer x, y; -y <= x <= y ==> 0 <= (y - x) * (y + x);
    lemma squared_both: \forall integer x, y; -y <= x <= y ==> is_squared_less(x, y);
*/
#include "search_ramps.h"

/* Speeding up: whatever the interval before was, what is predicted is not later than the slope says. */
/*@ predicate speeds(integer r, integer s, integer a, integer i, integer t) =
        is_speeding(r, s, a) && 0 <= i <= 0x40000000 && is_predicted(t, r, s + a * i);
    predicate guesses_speed(integer r, integer s, integer a, integer i, integer t, integer r2, integer s2) =
        speeds(r, s, a, i, t) && is_gone(r - STEP_QUANTA, s, a, t, r2, s2);
    lemma speeds_least: \forall integer r, s, a, i, t; speeds(r, s, a, i, t) ==> s <= s + a * i;
    lemma speeds_way: \forall integer r, s, a, i, t; speeds(r, s, a, i, t) ==>
        (t - 1) * (s + a * i - 0x80000000) <= STEP_QUANTA + s;
    lemma speeds_way_scaled: \forall integer r, s, a, i, t; speeds(r, s, a, i, t) && 1 <= t ==>
        is_less_scaled(8 * s, 10 * (s + a * i - 0x80000000), t - 1);
    lemma speeds_time: \forall integer r, s, a, i, t; speeds(r, s, a, i, t) ==> 8 * (t * s) <= 11 * STEP_QUANTA;
    lemma speeds_square: \forall integer r, s, a; is_speeding(r, s, a) ==> 396 * (a * STEP_QUANTA) <= 100 * (s * s);
    lemma speeds_gain_scaled: \forall integer r, s, a, i, t; speeds(r, s, a, i, t) ==>
        is_less_scaled(8 * (t * s), 11 * STEP_QUANTA, a);
    lemma speeds_gain_all: \forall integer r, s, a, i, t; speeds(r, s, a, i, t) ==>
        is_less_scaled(100 * (a * t), 35 * s, s);
    lemma speeds_gain: \forall integer r, s, a, i, t; speeds(r, s, a, i, t) ==> 100 * (a * t) <= 35 * s;
    lemma speeds_gain_way: \forall integer r, s, a, i, t; speeds(r, s, a, i, t) ==>
        is_less_scaled(100 * (a * t), 35 * s, t);
    lemma speeds_later: \forall integer r, s, a, i, t; speeds(r, s, a, i, t) ==>
        0 <= a * t && 0 <= (a * t) * t && 0 <= t * s;
    lemma speeds_gained: \forall integer r, s, a, i, t; speeds(r, s, a, i, t) ==>
        100 * ((a * t) * t) <= 35 * (t * s);
    lemma sped_slope: \forall integer r, s, a, i, t, r2, s2; guesses_speed(r, s, a, i, t, r2, s2) ==>
        s <= s2 && 10 * s2 <= 17 * s;
    lemma sped_residual: \forall integer r, s, a, i, t, r2, s2; guesses_speed(r, s, a, i, t, r2, s2) ==>
        -(102 * STEP_QUANTA) <= 100 * r2 <= 102 * STEP_QUANTA;
    lemma sped_residual_squared: \forall integer r, s, a, i, t, r2, s2; guesses_speed(r, s, a, i, t, r2, s2) ==>
        is_squared_less(100 * r2, 102 * STEP_QUANTA);
    lemma sped_residual_scaled: \forall integer r, s, a, i, t, r2, s2; guesses_speed(r, s, a, i, t, r2, s2) ==>
        is_less_scaled(100 * r2 * (100 * r2), 102 * STEP_QUANTA * (102 * STEP_QUANTA), a);
    lemma sped_slope_squared: \forall integer r, s, a, i, t, r2, s2; guesses_speed(r, s, a, i, t, r2, s2) ==>
        is_less_squared(s, s2);
    lemma sped_far: \forall integer r, s, a, i, t, r2, s2; guesses_speed(r, s, a, i, t, r2, s2) ==>
        a * r2 * r2 <= 0x800000000000000 * (s2 * s2);
    lemma sped_curve: \forall integer r, s, a, i, t, r2, s2; guesses_speed(r, s, a, i, t, r2, s2) ==>
        s2 * s2 - 4 * a * r2 == s * s - 4 * a * (r - STEP_QUANTA);
    lemma sped_guess: \forall integer r, s, a, i, t, r2, s2; guesses_speed(r, s, a, i, t, r2, s2) ==>
        is_guess(r2, s2, a);
*/
#endif
