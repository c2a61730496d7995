/*
 * Contracts of the kinds of leg in motion_legs.c: proved with motion_legs_kinds.acsl.
 */
#ifndef PROGRESS_H
#define PROGRESS_H

#include "plans.h"
#include "legs.h"

/* What legs need of their section's profile: from the last corner on the brake has as many steps as the speeds ask. */
/*@ predicate has_ramps(struct motion_profile profile) =
        has_speeds(profile) && 1 <= profile.accel_steps_per_s2 <= STEP_ACCEL_MAX &&
        profile.exit <= profile.cruise &&
        is_distance_of(profile.end - profile.corner_b.step, 4 * profile.accel_steps_per_s2,
            profile.cruise - profile.exit);
    predicate knows_slope(struct motion_progress *progress) =
        progress->twice_speed2 != 0 ==> is_slope(progress->slope);
    predicate is_same(struct motion_place a, struct motion_place b) = a.step == b.step && a.quanta == b.quanta;
    predicate is_step(struct motion_place place, integer step) = place.step == step && place.quanta == 0;
    predicate is_piece(struct motion_leg leg, struct motion_place end) =
        leg.to.step == leg.from.step + 0x40000000 && leg.to.quanta == 0 && leg.to.step < end.step;
    predicate is_last_piece(struct motion_leg leg, struct motion_place end) =
        leg.to == end && leg.to.step - leg.from.step <= 0x40000000;
*/

/*@ requires \valid(progress) && knows_slope(progress) && 2 <= twice_speed2 <= 2 * speed2_max;
    assigns progress->twice_speed2, progress->slope;
    ensures knows_slope(progress) && is_slope(\result);
*/
static uint64_t slope_of(struct motion_progress *progress, uint64_t twice_speed2);

/*@ requires \valid(progress) && \valid(leg) && \separated(progress, leg);
    requires knows_slope(progress) && has_ramps(progress->profile);
    assigns progress->twice_speed2, progress->slope;
    assigns leg->to, leg->accel, leg->from_slope, leg->to_slope, leg->pulse_twice_speed2;
    ensures knows_slope(progress);
    ensures leg->to.step == \old(progress->profile.corner_a.step);
    ensures leg->to.quanta == \old(progress->profile.corner_a.quanta);
    ensures 1 <= leg->accel <= STEP_ACCEL_MAX * STEP_ACCEL_PER_ACCEL;
    ensures is_slope(leg->from_slope) && is_slope(leg->to_slope) && leg->pulse_twice_speed2 <= 0x10000000000;
    ensures leg->from.step == \old(leg->from.step) && leg->from.quanta == \old(leg->from.quanta);
    ensures leg->start.ticks == \old(leg->start.ticks) && leg->start.fraction == \old(leg->start.fraction);
*/
static void leg_first_ramp(struct motion_progress *progress, struct motion_leg *leg);

/*@ requires \valid(progress) && \valid(leg) && \separated(progress, leg);
    requires knows_slope(progress) && has_ramps(progress->profile);
    requires leg->from.step <= progress->profile.corner_b.step;
    assigns progress->twice_speed2, progress->slope, leg->to, leg->from_slope, leg->to_slope;
    ensures knows_slope(progress) && is_slope(leg->from_slope) && is_slope(leg->to_slope);
    ensures is_piece(*leg, \old(progress->profile.corner_b)) ||
        is_last_piece(*leg, \old(progress->profile.corner_b));
    ensures leg->from.step == \old(leg->from.step) && leg->from.quanta == \old(leg->from.quanta);
    ensures leg->start.ticks == \old(leg->start.ticks) && leg->start.fraction == \old(leg->start.fraction);
*/
static void leg_cruise(struct motion_progress *progress, struct motion_leg *leg);

/*@ requires \valid(progress) && \valid(leg) && \separated(progress, leg);
    requires knows_slope(progress) && has_ramps(progress->profile);
    requires is_same(leg->from, progress->profile.corner_b) && leg->from.step < progress->profile.end;
    assigns progress->twice_speed2, progress->slope;
    assigns leg->to, leg->accel, leg->from_slope, leg->to_slope, leg->pulse_twice_speed2;
    ensures knows_slope(progress);
    ensures is_step(leg->to, \old(progress->profile.end));
    ensures 1 <= leg->accel <= STEP_ACCEL_MAX * STEP_ACCEL_PER_ACCEL;
    ensures is_slope(leg->from_slope) && is_slope(leg->to_slope) && leg->pulse_twice_speed2 <= 0x10000000000;
    ensures leg->from.step == \old(leg->from.step) && leg->from.quanta == \old(leg->from.quanta);
    ensures leg->start.ticks == \old(leg->start.ticks) && leg->start.fraction == \old(leg->start.fraction);
*/
static void leg_last_ramp(struct motion_progress *progress, struct motion_leg *leg);

#endif
