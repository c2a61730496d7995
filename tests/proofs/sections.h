/*
 * The profile of a section, or of its part of a stop, as motion_legs.c fits it: proved with motion_legs_section.acsl.
 */
#ifndef SECTIONS_H
#define SECTIONS_H

#include "ready.h"
#include "progress.h"

/* A ramp is one segment, which counts its pulses in 32 bits: how high the square of a speed may be for that. */
/*@ predicate is_short(integer speed2, integer accel) = speed2 <= 2 * accel * 0xFFFFFFFE;
    predicate is_short_in(struct motion_order *order, integer i, integer speed2) =
        is_short(speed2, order->section[i].accel_steps_per_s2);
    predicate is_short_ramped_at(struct motion_plan *plan, integer i) =
        is_short_in(&plan->order, i, enter_of(plan, i)) && is_short_in(&plan->order, i, limit_of(&plan->order, i));
    predicate is_short_ramped(struct motion_plan *plan) =
        \forall integer i; plan->first <= i < plan->order.sections ==> is_short_ramped_at(plan, i);
    predicate has_short_ramps(struct motion_profile profile) =
        profile.corner_a.step - profile.begin <= 0xFFFFFFFF && profile.end - profile.corner_b.step <= 0xFFFFFFFF;
*/

/* A profile from border to border; that of a stop ends at its only corner, which is the border but for the last. */
/*@ logic integer corner_step_max = 11 * MOTION_ENDLESS_STEPS;
    predicate is_profile_of(struct motion_profile profile, integer begin, integer end) =
        has_ramps(profile) && has_corners(profile) && profile.begin == begin && profile.end == end;
    predicate is_stop_of(struct motion_profile profile, integer begin) =
        has_ramps(profile) && is_place(profile.corner_a) && profile.begin == begin &&
        begin * STEP_QUANTA <= quanta(profile.corner_a);
*/

/*@ requires \valid_read(plan) && is_ready(plan) && plan->first <= section < plan->order.sections;
    assigns \nothing;
    ensures speeds: has_speeds(\result) && \result.end <= corner_step_max;
    ensures ramps: has_ramps(\result) && \result.begin == span_begin(plan, section);
    ensures profile: plan->kind != MOTION_PLAN_STOP ==>
        is_profile_of(\result, span_begin(plan, section), begin_of(&plan->order, section + 1));
    ensures stop: plan->kind == MOTION_PLAN_STOP ==> is_stop_of(\result, span_begin(plan, section));
    ensures border: plan->kind == MOTION_PLAN_STOP && section + 1 < plan->order.sections ==>
        is_step(\result.corner_a, begin_of(&plan->order, section + 1));
    ensures short_ramps: is_short_ramped_at(plan, section) ==> has_short_ramps(\result);
*/
struct motion_profile motion_legs_fit_section(const struct motion_plan *plan, unsigned section);

#endif
