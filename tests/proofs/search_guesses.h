/*
 * What the search for a pulse begins with: positions and slopes, and guesses from which it ends near the pulse.
 */
#ifndef SEARCH_GUESSES_H
#define SEARCH_GUESSES_H

#include "step_scale.h"

/* Products. */
/*@ predicate is_less_squared(integer x, integer y) = x * x <= y * y;
    lemma less_squared: \forall integer x, y; 0 <= x <= y ==> is_less_squared(x, y);
    predicate is_less_scaled(integer x, integer y, integer z) = x * z <= y * z;
    lemma less_scaled: \forall integer x, y, z; 0 <= z && x <= y ==> is_less_scaled(x, y, z);
    lemma less_root: \forall integer x, y; 0 <= x && 0 <= y && is_less_squared(x, y) ==> x <= y;
    lemma less_divided: \forall integer x, y, z; 1 <= z && x * z <= y * z ==> x <= y;
    predicate is_gain(integer q, integer a, integer n) = 0 <= a * q <= n * a && 0 <= a * q * q <= n * n * a;
    lemma gain_2: \forall integer q, a; 0 <= q <= 2 && 0 <= a ==> is_gain(q, a, 2);
    lemma gain_4: \forall integer q, a; 0 <= q <= 4 && 0 <= a ==> is_gain(q, a, 4);
*/
/* A residual of a few ticks. */
/*@ predicate is_close(integer r, integer s) = -(4 * s) <= r <= 4 * s;
    predicate is_accel(integer a) = -1024000000 <= a <= 1024000000;
    predicate is_far_in_reach(integer r, integer s, integer a) = a * r * r <= 0x800000000000000 * (s * s) &&
        -(a * r * r) <= 0x800000000000000 * (s * s);
    lemma close_above: \forall integer r, s; 0 <= r && is_close(r, s) ==> is_less_squared(r, 4 * s);
    lemma close_below: \forall integer r, s; r < 0 && is_close(r, s) ==> is_less_squared(-r, 4 * s);
    lemma close_square: \forall integer r, s; is_close(r, s) ==> r * r <= 16 * (s * s);
    lemma close_accel: \forall integer r, a; is_accel(a) ==>
        is_less_scaled(a, 1024000000, r * r) && is_less_scaled(-a, 1024000000, r * r);
    lemma close_in_reach: \forall integer r, s, a; is_close(r, s) && is_accel(a) ==> is_far_in_reach(r, s, a);
*/
/* A guess of a pulse: residual and slope there, from which a search ends. Far in reach is what one correction leaves
 * below 2^61. */
/*@ logic integer size(integer x) = x < 0 ? -x : x;
    logic integer curve(integer r, integer s, integer a) = s * s - 4 * a * r;
    predicate is_crossing(integer r, integer s, integer a) = 21000000000 * 21000000000 <= curve(r, s, a);
    predicate is_guess(integer r, integer s, integer a) = is_accel(a) && -0x2000000000000000 < r < 0x2000000000000000 &&
        0x280000000 <= s && 10 * a <= s && -(10 * a) <= s && is_crossing(r, s, a) && is_far_in_reach(r, s, a);
    predicate is_tame(integer r, integer s, integer a) = -(9 * a * r) <= s * s;
    predicate is_near(integer r, integer s) = -(s / 2) <= r <= s - s / 2;
    predicate is_beyond(integer r, integer s) = 4 * s < r;
*/
/* Position and slope `ticks` ticks later. */
/*@ logic integer position(integer residual, integer slope, integer accel, integer ticks) =
        residual + ticks * (slope + accel * ticks);
    logic integer speed(integer slope, integer accel, integer ticks) = slope + 2 * accel * ticks;
    lemma position_sum: \forall integer r, s, a, t, u; position(position(r, s, a, t), speed(s, a, t), a, u) ==
        position(r, s, a, t + u);
    lemma speed_sum: \forall integer s, a, t, u; speed(speed(s, a, t), a, u) == speed(s, a, t + u);
*/
/* What the code has, modulo 2^64. */
/*@ logic integer signed_64(integer x) = x <= 0x7FFFFFFFFFFFFFFF ? x : x - 0x10000000000000000;
*/
/* Position and slope that a search stands on, seen from a beginning. */
/*@ predicate is_at(integer residual, integer slope, integer interval, integer r, integer s, integer a,
        integer ticks) =
        signed_64(residual) == position(r, s, a, ticks) && slope == speed(s, a, ticks) &&
        interval == (uint32_t)ticks;
*/
/* A good guess of the next pulse's interval. */
/*@ predicate is_well_guessed(integer r, integer s, integer a, integer ticks) =
        -0x4000000000000000 <= r <= 0x4000000000000000 && speed(s, a, ticks) < 0x200000000000000 &&
        is_guess(position(r - STEP_QUANTA, s, a, ticks), speed(s, a, ticks), a);
*/
/* From a whole step on, a search ends at a later tick. */
/*@ predicate is_found(integer r, integer s, integer a, integer ticks) =
        0x280000000 <= speed(s, a, ticks) < 0x400000000000000 &&
        is_near(position(r - STEP_QUANTA, s, a, ticks), speed(s, a, ticks));
    lemma found_way: \forall integer r, s, a, t; 2 * position(r, s, a, t) == 2 * r + t * (s + speed(s, a, t));
    lemma found_sum: \forall integer r, s, a, t; is_found(r, s, a, t) ==>
        -2 * speed(s, a, t) <= 2 * (r - STEP_QUANTA) + t * (s + speed(s, a, t)) <= 2 * speed(s, a, t);
    lemma found_later: \forall integer r, s, a, t; 0 < s < 0x400000000000000 && is_near(r, s) &&
        is_found(r, s, a, t) ==>
        1 <= t;
    predicate is_within_step(integer t, integer w) = (t - 2) * w <= 2 * STEP_QUANTA;
    lemma soon: \forall integer t, w; 0x280000000 <= w && is_within_step(t, w) ==> t <= 0x20000000;
    lemma found_within: \forall integer r, s, a, t; 0 < s < 0x400000000000000 && is_near(r, s) &&
        is_found(r, s, a, t) ==> is_within_step(t, s + speed(s, a, t));
    lemma found_soon: \forall integer r, s, a, t; 0 < s < 0x400000000000000 && is_near(r, s) && is_found(r, s, a, t) ==>
        t <= 0x20000000;
*/
#endif
