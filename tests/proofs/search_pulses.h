/*
 * From one pulse of a ramp to the next: what is predicted there is a good guess, and after a pulse that is near a whole
 * step the ramp goes on. Whole numbers that do not wrap.
 */
#ifndef SEARCH_PULSES_H
#define SEARCH_PULSES_H

/* How a ramp's square of the slope at whole steps changes: not by its own pulses. */
/*@ predicate is_counted(integer a, integer n) = a * n <= a;
    lemma counted: \forall integer a, n; a <= 0 && 1 <= n ==> is_counted(a, n);
    logic integer most_square = 0x40000000000000 * 0x40000000000000;
    predicate is_below_top(integer s) = s * s <= most_square + 1024000000 * (4 * s);
    lemma above_top: \forall integer s; 0x80000000000000 < s ==>
        0x40000000000000 * 0x80000000000000 <= s * (s - 4096000000);
    lemma below_top: \forall integer s; is_below_top(s) ==> s <= 0x80000000000000;
    logic integer rest_of(integer r, integer s, integer a) = s * s - 4 * a * r;
    lemma rest_moved: \forall integer x, s, a, t; rest_of(x + t * (s + a * t), s + 2 * a * t, a) == rest_of(x, s, a);
    predicate is_moved(integer x, integer s, integer a, integer t, integer r2, integer s2) =
        r2 == x + t * (s + a * t) && s2 == s + 2 * a * t;
    lemma moved_rest: \forall integer x, s, a, t, r2, s2; is_moved(x, s, a, t, r2, s2) ==>
        rest_of(r2, s2, a) == rest_of(x + t * (s + a * t), s + 2 * a * t, a);
    lemma moved_same: \forall integer x, s, a, t, r2, s2; is_moved(x, s, a, t, r2, s2) ==>
        rest_of(r2, s2, a) == rest_of(x, s, a);
    lemma moved_back: \forall integer x, s, a, t, r2, s2; is_moved(x, s, a, t, r2, s2) ==>
        r2 == x + t * s2 - (a * t) * t;
*/
#include "search_braking.h"
#include "search_speeding.h"

/*@ lemma moved_down: \forall integer x, s, a, t, r2, s2; is_moved(x, s, a, t, r2, s2) ==>
        is_brake_moved(x, s, -a, t, r2, s2);
    lemma moved_up: \forall integer x, s, a, t, r2, s2; is_moved(x, s, a, t, r2, s2) ==>
        is_gone(x, s, a, t, r2, s2);
*/

/* A pulse of a ramp of which so many are still to come; i is the interval before it, which matters where the motor
 * brakes. The slope at all of its whole steps is that of 0.98 steps/s at least, also at the one before where the motor
 * speeds up, and at most 2^54. */
/*@ predicate is_on_ramp(integer r, integer s, integer a, integer i, integer pulses) =
        is_accel(a) && 0 < s && is_near(r, s) && 0 <= i <= 0x40000000 && 0 <= pulses &&
        (0 <= a ==> least_square <= curve(r + STEP_QUANTA, s, a) &&
            curve(r - pulses * STEP_QUANTA, s, a) <= most_square) &&
        (a <= 0 ==> least_square <= curve(r - pulses * STEP_QUANTA, s, a) && curve(r, s, a) <= most_square) &&
        (a <= 0 && 1 <= pulses ==> is_before(i, r, s, -a));
    lemma ramp_near_up: \forall integer r, s, a; 0 <= a && 0 < s && is_near(r, s) ==> is_less_scaled(r, s, a);
    lemma ramp_near_down: \forall integer r, s, a; a <= 0 && 0 < s && is_near(r, s) ==> is_less_scaled(-r, s, -a);
    lemma ramp_accel_up: \forall integer s, a; is_accel(a) && 0 < s ==> is_less_scaled(a, 1024000000, s);
    lemma ramp_accel_down: \forall integer s, a; is_accel(a) && 0 < s ==> is_less_scaled(-a, 1024000000, s);
    lemma ramp_pulses: \forall integer pulses, a; 0 <= a && 0 <= pulses ==> 0 <= a * pulses;
    lemma ramp_pulses_more: \forall integer pulses, a; 0 <= a && 1 <= pulses ==> a <= a * pulses;
    lemma ramp_square: \forall integer r, s, a, i, pulses; is_on_ramp(r, s, a, i, pulses) ==>
        s * s <= most_square + 4 * (a * r);
    lemma ramp_product_up: \forall integer r, s, a; 0 <= a && is_accel(a) && 0 < s && is_near(r, s) ==>
        a * r <= 1024000000 * s;
    lemma ramp_product_down: \forall integer r, s, a; a <= 0 && is_accel(a) && 0 < s && is_near(r, s) ==>
        a * r <= 1024000000 * s;
    lemma ramp_square_more: \forall integer r, s, a, i, pulses; is_on_ramp(r, s, a, i, pulses) ==>
        is_below_top(s);
    lemma ramp_slope: \forall integer r, s, a, i, pulses; is_on_ramp(r, s, a, i, pulses) ==> s <= 0x80000000000000;
    lemma ramp_speeding: \forall integer r, s, a, i, pulses; 0 <= a && is_on_ramp(r, s, a, i, pulses) ==>
        is_speeding(r, s, a);
    lemma ramp_braking: \forall integer r, s, a, i, pulses; a <= 0 && 1 <= pulses &&
        is_on_ramp(r, s, a, i, pulses) ==> is_braking(r, s, -a);
    lemma ramp_interval: \forall integer a, i; 0 <= a <= 1024000000 && 0 <= i <= 0x40000000 ==>
        0 <= a * i <= 0x1000000000000000;
    lemma ramp_up_gain: \forall integer r, s, a, i, pulses; 0 <= a && is_on_ramp(r, s, a, i, pulses) ==>
        0 <= a * i <= 0x1000000000000000;
    lemma ramp_up_about: \forall integer r, s, a, i, pulses; 0 <= a && is_on_ramp(r, s, a, i, pulses) ==>
        0x200000000 <= s + a * i < 0x2000000000000000;
    lemma ramp_down_about: \forall integer r, s, a, i, pulses; a <= 0 && 1 <= pulses &&
        is_on_ramp(r, s, a, i, pulses) ==> 0x200000000 <= s + a * i < 0x2000000000000000;
    predicate predicts(integer r, integer s, integer a, integer i, integer pulses, integer t, integer r2,
        integer s2) = is_on_ramp(r, s, a, i, pulses) && 1 <= pulses && is_predicted(t, r, s + a * i) &&
        is_moved(r - STEP_QUANTA, s, a, t, r2, s2);
    lemma predicts_speeds: \forall integer r, s, a, i, pulses, t, r2, s2; 0 <= a &&
        predicts(r, s, a, i, pulses, t, r2, s2) ==> guesses_speed(r, s, a, i, t, r2, s2);
    lemma predicts_brakes: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 &&
        predicts(r, s, a, i, pulses, t, r2, s2) ==>
            guesses_brake(r, s, -a, i, t, s - (-a) * i - 0x80000000, r2, s2);
    lemma predicts_guess: \forall integer r, s, a, i, pulses, t, r2, s2;
        predicts(r, s, a, i, pulses, t, r2, s2) ==> is_guess(r2, s2, a);
    lemma predicts_slope: \forall integer r, s, a, i, pulses, t, r2, s2;
        predicts(r, s, a, i, pulses, t, r2, s2) ==> s2 < 0x100000000000000;
*/
/* The next pulse. */
/*@ predicate goes_on(integer r, integer s, integer a, integer i, integer pulses, integer t, integer r2,
        integer s2) = is_on_ramp(r, s, a, i, pulses) && 1 <= pulses && is_moved(r - STEP_QUANTA, s, a, t, r2, s2) &&
        is_near(r2, s2) && 0 < s2 && 1 <= t <= 0x20000000;
    lemma next_curve: \forall integer r, s, a, i, pulses, t, r2, s2; goes_on(r, s, a, i, pulses, t, r2, s2) ==>
        s2 * s2 - 4 * (a * r2) == s * s - 4 * (a * r) + 4 * (a * STEP_QUANTA);
    lemma next_up: \forall integer r, s, a, i, pulses, t, r2, s2; 0 <= a && goes_on(r, s, a, i, pulses, t, r2, s2) ==>
        least_square <= curve(r2 + STEP_QUANTA, s2, a);
    lemma next_up_top: \forall integer r, s, a, i, pulses, t, r2, s2; 0 <= a &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==>
            curve(r2 - (pulses - 1) * STEP_QUANTA, s2, a) <= most_square;
    lemma next_down: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 && goes_on(r, s, a, i, pulses, t, r2, s2) ==>
        least_square <= curve(r2 - (pulses - 1) * STEP_QUANTA, s2, a);
    lemma next_down_top: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> curve(r2, s2, a) <= most_square;
    lemma next_slope: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> s2 <= s && s <= 0x80000000000000;
    lemma next_gain: \forall integer a, t; a <= 0 && 1 <= t ==> (-a * t) <= (-a * t) * t;
    lemma next_back: \forall integer r, s, a, i, pulses, t, r2, s2; goes_on(r, s, a, i, pulses, t, r2, s2) ==>
        r2 == r - STEP_QUANTA + t * s2 - (a * t) * t;
    lemma next_before: \forall integer r, s, a, i, pulses, t, r2, s2; goes_on(r, s, a, i, pulses, t, r2, s2) ==>
        s == s2 - 2 * (a * t);
    lemma next_gained: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> (a * t) * t <= a * t;
    lemma next_way: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> t * s2 <= STEP_QUANTA + s2 + 1;
    lemma next_way_scaled: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> is_less_scaled(t * s2, STEP_QUANTA + s2 + 1, -a);
    lemma next_pulse: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> is_pulse(r2, s2, -a);
    lemma next_down_all: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==>
            least_square <= s2 * s2 - 4 * (a * r2) + 4 * ((a * (pulses - 1)) * STEP_QUANTA);
    lemma next_pulses_counted: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 && 2 <= pulses &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> is_counted(a, pulses - 1);
    lemma next_pulses: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 && 2 <= pulses &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> a * (pulses - 1) <= a;
    lemma next_square_ahead: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 && 2 <= pulses &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> least_square <= s2 * s2 - 4 * (a * r2) + 4 * (a * STEP_QUANTA);
    lemma next_curve_ahead: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 && 2 <= pulses &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> least_square <= curve(r2 - STEP_QUANTA, s2, a);
    lemma next_braking: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 && 2 <= pulses &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> is_braking(r2, s2, -a);
    lemma next_interval_scaled: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 && 2 <= pulses &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> is_less_scaled(4 * (-a * t), s2 + 10 * -a, s2);
    lemma next_interval: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 && 2 <= pulses &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> is_interval_before(t, s2, -a);
    lemma next_has_before: \forall integer r, s, a, i, pulses, t, r2, s2; a <= 0 && 2 <= pulses &&
        goes_on(r, s, a, i, pulses, t, r2, s2) ==> is_before(t, r2, s2, -a);
    lemma next: \forall integer r, s, a, i, pulses, t, r2, s2; goes_on(r, s, a, i, pulses, t, r2, s2) ==>
        is_on_ramp(r2, s2, a, t, pulses - 1);
*/
#endif
