/*
 * How far segments have been taken from a plan, and that each leg begins where the one before it ends: contracts proved
 * with motion_legs_profile.acsl, _advance, _take and motion_plan_next.acsl.
 */
#ifndef UNDER_WAY_H
#define UNDER_WAY_H

#include "sections.h"
#include "kept_progress.h"
#include "made_legs.h"

/* The progress stands on a leg of its section's profile, or at the beginning of a section that has none yet. */
/*@ predicate has_profile(struct motion_plan *plan, integer section) =
        plan->kind == MOTION_PLAN_STOP ? is_stop_of(plan->progress.profile, span_begin(plan, section)) &&
            (section + 1 < plan->order.sections ==>
                is_step(plan->progress.profile.corner_a, begin_of(&plan->order, section + 1))) :
            is_profile_of(plan->progress.profile, span_begin(plan, section), begin_of(&plan->order, section + 1));
    predicate is_at_begin(struct motion_plan *plan) =
        plan->progress.leg == 0 && is_step(plan->progress.place, span_begin(plan, plan->progress.section));
    predicate is_between(struct motion_plan *plan) =
        plan->progress.leg >= 1 && plan->kind != MOTION_PLAN_STOP && is_place(plan->progress.place) &&
        quanta(plan->progress.profile.corner_a) <= quanta(plan->progress.place) &&
        quanta(plan->progress.place) <= quanta(plan->progress.profile.corner_b) &&
        (plan->progress.leg == 2 ==> is_same(plan->progress.place, plan->progress.profile.corner_b));
    predicate is_placed(struct motion_plan *plan) =
        plan->progress.leg <= 2 && (is_at_begin(plan) || is_between(plan));
    predicate has_fitted(struct motion_plan *plan) =
        has_profile(plan, plan->progress.section) && has_short_ramps(plan->progress.profile);
    predicate goes_on(struct motion_plan *plan) =
        plan->first <= plan->progress.section <= plan->order.sections && plan->progress.leg <= 2 &&
        (plan->progress.section < plan->order.sections ==>
            is_at_begin(plan) || (is_between(plan) && has_fitted(plan)));
    predicate is_under_way(struct motion_plan *plan) =
        is_ready(plan) && is_short_ramped(plan) && knows_slope(&plan->progress) && goes_on(plan);
    logic integer legs_left(struct motion_plan *plan) =
        3 * (plan->order.sections - plan->progress.section) - plan->progress.leg;
*/

/*@ requires \valid(plan) && is_ready(plan) && plan->first <= plan->progress.section < plan->order.sections;
    requires has_fitted(plan) && plan->progress.leg <= 2 && (plan->progress.leg >= 1 ==>
        plan->kind != MOTION_PLAN_STOP);
    requires is_at_end(plan->progress.leg, plan->progress.profile, plan->progress.place);
    assigns plan->progress.leg, plan->progress.section;
    ensures goes_on: goes_on(plan);
    ensures plan_kept: keeps_plan{Old, Post}(plan);
    ensures slope_kept: keeps_slope{Old, Post}(plan);
    ensures left: legs_left(plan) < \old(legs_left(plan));
*/
static void next_leg(struct motion_plan *plan);

/*@ requires \valid(plan) && \valid_read(leg) && \separated(plan, leg);
    requires is_ready(plan) && plan->first <= plan->progress.section < plan->order.sections;
    requires has_fitted(plan) && is_placed(plan);
    requires begins_at(*leg, plan->progress.place);
    requires ends_well(plan->progress.leg, *leg, plan->progress.profile);
    assigns plan->progress.time, plan->progress.place, plan->progress.leg, plan->progress.section;
    ensures goes_on: goes_on(plan);
    ensures plan_kept: keeps_plan{Old, Post}(plan);
    ensures slope_kept: keeps_slope{Old, Post}(plan);
    ensures leg_kept: *leg == \old(*leg);
    ensures time: \forall integer start; lasts_from(\old(*leg), start) ==>
        plan->progress.time.ticks <= start + leg_ticks_max;
    ensures left: has_no_pulse(\old(*leg)) ==> legs_left(plan) < \old(legs_left(plan));
*/
static void advance(struct motion_plan *plan, const struct motion_leg *leg);

/*@ requires \valid(plan) && is_under_way(plan) && plan->progress.section < plan->order.sections;
    assigns plan->progress.profile;
    ensures whole: keeps_plan{Old, Post}(plan);
    ensures fitted: has_fitted(plan);
    ensures placed: is_placed(plan);
*/
static void fit_profile(struct motion_plan *plan);

/*@ requires \valid(plan) && \valid(leg) && \base_addr(plan) != \base_addr(leg);
    requires is_under_way(plan) && plan->progress.time.ticks < 0x4000000000000000;
    assigns plan->progress, *leg;
    ensures under_way: is_under_way(plan);
    ensures fitted: \result ==> is_leg(leg) && is_timed(leg);
    ensures pulses: \result ==> 1 <= leg->to.step - leg->from.step <= 0xFFFFFFFF;
    ensures order: \result ==> is_order(&plan->order);
    ensures end: !\result ==> plan->progress.section == plan->order.sections;
*/
static bool take_leg(struct motion_plan *plan, struct motion_leg *leg);

/*@ requires \valid_read(plan) && \valid_read(leg);
    assigns \nothing;
*/
static bool is_mark(const struct motion_plan *plan, const struct motion_leg *leg);

/*@ requires \valid(plan) && \valid(segment) && \base_addr(plan) != \base_addr(segment);
    requires is_under_way(plan) && plan->progress.time.ticks < 0x4000000000000000;
    assigns plan->progress, *segment;
    ensures under_way: is_under_way(plan);
    ensures pulses: \result ==> 1 <= segment->steps <= 0xFFFFFFFF;
    ensures end: !\result ==> plan->progress.section == plan->order.sections;
*/
bool motion_plan_next(struct motion_plan *plan, struct step_segment *segment);

#endif
