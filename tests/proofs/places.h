/*
 * Contracts of motion_time.h, proved with motion_time.acsl.
 */
#ifndef PLACES_H
#define PLACES_H

#include "motion_time.h"
#include "step_scale.h"

/*@ logic integer fractions(struct motion_time time) = time.ticks * 0x100000000 + time.fraction;
    logic integer quanta(struct motion_place place) = place.step * STEP_QUANTA + place.quanta;
    predicate is_place(struct motion_place place) = place.quanta < STEP_QUANTA;
    predicate is_nearest(integer place, integer x, integer denominator) =
        place * denominator <= x * STEP_QUANTA + denominator / 2 < place * denominator + denominator;
*/

/*@ requires 1 <= divisor <= 0x8000000000000000;
    requires time.ticks <= 0x8000000000000000;
    requires value(dividend) < 0x7FFFFFFFFFFFFFFF * divisor;
    assigns \nothing;
    ensures (fractions(\result) - fractions(time)) * divisor <= value(dividend) * 0x100000000;
    ensures fractions(time) <= fractions(\result);
*/
struct motion_time motion_time_add(struct motion_time time, struct wide dividend, uint64_t divisor);

/*@ requires time.ticks < 0xFFFFFFFFFFFFFFFF;
    assigns \nothing;
    ensures fractions(time) <= \result * 0x100000000 < fractions(time) + 0x100000000;
*/
uint64_t motion_time_up(struct motion_time time);

/*@ requires is_place(a) && is_place(b) && quanta(a) <= quanta(b);
    assigns \nothing;
    ensures value(\result) == quanta(b) - quanta(a);
*/
struct wide motion_place_distance(struct motion_place a, struct motion_place b);

/*@ assigns \nothing;
    ensures \result <==> a.step == b.step && a.quanta == b.quanta;
*/
bool motion_place_is_same(struct motion_place a, struct motion_place b);

/*@ requires 1 <= denominator <= 0x100000000;
    requires step + numerator / denominator <= 0xFFFFFFFFFFFFFFFF;
    assigns \nothing;
    ensures \result.step == step + numerator / denominator;
    ensures is_place(\result);
    ensures is_nearest(quanta(\result), step * denominator + numerator, denominator);
*/
struct motion_place motion_place_add(uint64_t step, uint64_t numerator, uint64_t denominator);

/*@ requires 1 <= denominator <= 0x100000000;
    requires numerator <= 0x8000000000000000;
    requires numerator <= step * denominator;
    assigns \nothing;
    ensures is_place(\result);
    ensures is_nearest(quanta(\result), step * denominator - numerator, denominator);
    ensures \result.step <= step;
    ensures (step - \result.step) * denominator <= numerator + denominator;
*/
struct motion_place motion_place_subtract(uint64_t step, uint64_t numerator, uint64_t denominator);

#endif
