/*
 * Contracts of motion_leg.h, proved with motion_leg.acsl.
 */
#ifndef LEGS_H
#define LEGS_H

#include "motion_leg.h"
#include "places.h"
#include "step_generator.h"

/*@ logic integer leg_ticks_max = 0x200000000000000;
    predicate is_slope(integer slope) = STEP_SLOPE_PER_SPEED <= slope <= 0x40000000000000;
    predicate is_leg(struct motion_leg *leg) =
        is_place(leg->from) && is_place(leg->to) && quanta(leg->from) <= quanta(leg->to) &&
        leg->accel <= STEP_ACCEL_MAX * STEP_ACCEL_PER_ACCEL &&
        is_slope(leg->from_slope) && is_slope(leg->to_slope) &&
        leg->pulse_twice_speed2 <= 0x10000000000 && leg->start.ticks < 0x8000000000000000;
    predicate is_lasting(struct motion_leg *leg, integer start) =
        start <= leg->end.ticks <= start + leg_ticks_max;
    predicate is_product(integer x, integer y, integer most) = x * y <= most;
    predicate is_ramp_time(integer time, integer accel, integer change) =
        is_product(time, 2 * accel, change * 0x100000000);
    predicate is_timed(struct motion_leg *leg) =
        leg->accel >= 1 ==> leg->start.ticks <= leg->end.ticks &&
            is_ramp_time(fractions(leg->end) - fractions(leg->start), leg->accel,
                \abs(leg->to_slope - leg->from_slope));
*/

/*@ requires twice_speed2 <= 0x100000000000000;
    assigns \nothing;
    ensures \result * \result - \result <= twice_speed2 * STEP_QUANTA * 128 <= \result * \result + \result;
    ensures twice_speed2 <= 0x10000000000 ==> \result <= 0x40000000000000;
    ensures 2 <= twice_speed2 ==> STEP_SLOPE_PER_SPEED <= \result;
*/
uint64_t motion_leg_slope(uint64_t twice_speed2);

/*@ requires \valid(leg) && is_leg(leg);
    requires leg->accel == 0 ==> leg->to.step - leg->from.step <= 0x40000000;
    assigns leg->end;
    ensures is_lasting(leg, \old(leg->start.ticks));
    ensures leg->from == \old(leg->from) && leg->to == \old(leg->to);
    ensures leg: is_leg(leg);
    ensures timed: is_timed(leg);
*/
void motion_leg_set_end(struct motion_leg *leg);

/*@ requires \valid_read(leg) && leg->from.step <= leg->to.step;
    assigns \nothing;
    ensures \result == leg->to.step - leg->from.step;
*/
uint64_t motion_leg_pulses(const struct motion_leg *leg);

/*@ requires \valid_read(leg) && is_leg(leg) && is_timed(leg);
    requires 1 <= leg->to.step - leg->from.step <= 0xFFFFFFFF;
    assigns \nothing;
    ensures \result.steps == leg->to.step - leg->from.step;
    ensures leg->accel == 0 ==> \result.pace_ticks * leg->from_slope <= STEP_QUANTA;
    ensures leg->accel == 0 ==> STEP_QUANTA < \result.pace_ticks * leg->from_slope + leg->from_slope;
    ensures leg->accel == 0 ==> 1 <= \result.pace_ticks <= STEP_INTERVAL_TICKS_MAX;
*/
struct step_segment motion_leg_segment(const struct motion_leg *leg);

#endif
