/*
 * Pulses of a ramp after which one more comes, and what is predicted there. Whole numbers that do not wrap.
 *
 * The slope at a whole step is that of 0.98 steps/s at least: where the motor brakes, at the next; where it speeds up,
 * at the one before.
 */
#ifndef SEARCH_RAMPS_H
#define SEARCH_RAMPS_H

#include "search_predicted.h"

/* A pulse of a ramp after which one more comes; b is the size of a braking acceleration. */
/*@ logic integer least_square = 21000000000 * 21000000000;
    predicate is_pulse(integer r, integer s, integer b) =
        0 <= b <= 1024000000 && 0 < s <= 0x80000000000000 && is_near(r, s);
    predicate is_braking(integer r, integer s, integer b) =
        is_pulse(r, s, b) && least_square <= s * s + 4 * (b * r) - 4 * (b * STEP_QUANTA);
    predicate is_speeding(integer r, integer s, integer a) =
        is_pulse(r, s, a) && least_square <= s * s - 4 * (a * r) - 4 * (a * STEP_QUANTA);

    lemma pulse_ahead: \forall integer r, s, b; is_pulse(r, s, b) ==> is_less_scaled(2 * r, s + 1, b);
    lemma pulse_back: \forall integer r, s, b; is_pulse(r, s, b) ==> is_less_scaled(-(2 * r), s + 1, b);
    lemma pulse_short: \forall integer r, s, b; is_pulse(r, s, b) ==> is_less_scaled(50 * (s + 1), STEP_QUANTA, b);
    lemma braking_square: \forall integer r, s, b; is_braking(r, s, b) ==>
        4 * (b * STEP_QUANTA) + least_square <= s * s + 2 * (b * s) + 2 * b;
    lemma speeding_square: \forall integer r, s, a; is_speeding(r, s, a) ==>
        4 * (a * STEP_QUANTA) + least_square <= s * s + 2 * (a * s) + 2 * a;
    predicate is_steep(integer s, integer b) = 0 <= b <= 1024000000 && 0 < s <= 0x80000000000000 &&
        4 * (b * STEP_QUANTA) + least_square <= s * s + 2 * (b * s) + 2 * b;
    lemma steep_square: \forall integer s, b; is_steep(s, b) ==> is_less_squared(21000000000, s);
    lemma steep: \forall integer s, b; is_steep(s, b) ==> 21000000000 <= s;
    lemma steep_ahead: \forall integer s, b; is_steep(s, b) ==> 7 * (b * 1000000000000000000) <= s * s;
    lemma steep_slow: \forall integer s, b; is_steep(s, b) && s <= 1024000000000 ==>
        is_less_scaled(s, 1024000000000, s);
    lemma steep_accel_slow: \forall integer s, b; is_steep(s, b) && s <= 1024000000000 ==> 1000 * b <= s;
    lemma steep_accel: \forall integer s, b; is_steep(s, b) ==> 1000 * b <= s;
    lemma braking_steep: \forall integer r, s, b; is_braking(r, s, b) ==> is_steep(s, b);
    lemma speeding_steep: \forall integer r, s, a; is_speeding(r, s, a) ==> is_steep(s, a);
*/
/*@ lemma less_scaled_divided: \forall integer x, y, z; 1 <= z && is_less_scaled(x, y, z) ==> x <= y;
*/
#endif
