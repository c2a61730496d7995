/*
 * Contracts of what the parts of a plan share, and of its look-ahead: proved with motion_plan.acsl,
 * motion_lookahead.acsl and motion_lookahead_forward.acsl.
 */
#ifndef PLANS_H
#define PLANS_H

#include "lower.h"
#include "motion_endless.h"
#include "motion_plan_private.h"
#include "motion_leg.h"
#include "step_scale.h"
#include "wide.h"

/* Of a gain the planner needs only that it is what motion_gain returns, proved in motion_profile.acsl. */
/*@ axiomatic Gain { logic integer gain_of(integer accel, integer steps); } */
#include "profiles.h"

/*@ logic integer steps_of(struct motion_order *order, integer section, integer place) =
        place < section ? order->section[place].steps : 0;
    logic integer begin_of(struct motion_order *order, integer section) =
        steps_of(order, section, 0) + steps_of(order, section, 1) + steps_of(order, section, 2) +
        steps_of(order, section, 3) + steps_of(order, section, 4) + steps_of(order, section, 5) +
        steps_of(order, section, 6) + steps_of(order, section, 7) + steps_of(order, section, 8) +
        steps_of(order, section, 9);
    predicate is_order(struct motion_order *order) =
        1 <= order->sections <= MOTION_SECTIONS && 1 <= order->start_speed_steps_per_s <= MOTION_SPEED_MAX &&
        \forall integer i; 0 <= i < MOTION_SECTIONS ==> i < order->sections ==>
            1 <= order->section[i].steps <= MOTION_ENDLESS_STEPS &&
            1 <= order->section[i].speed_steps_per_s <= MOTION_SPEED_MAX &&
            1 <= order->section[i].accel_steps_per_s2 <= STEP_ACCEL_MAX;
    predicate has_order(struct motion_plan *plan) = plan->order.sections == 0 || is_order(&plan->order);
    predicate is_plan(struct motion_plan *plan) =
        is_order(&plan->order) && plan->first < plan->order.sections &&
        begin_of(&plan->order, plan->first) <= plan->origin.step <
            begin_of(&plan->order, plan->first) + plan->order.section[plan->first].steps &&
        speed2_in_range(plan->origin.speed2);
    predicate has_exits(struct motion_plan *plan) =
        \forall integer i; plan->first <= i < plan->order.sections ==> speed2_in_range(plan->exit_speed2[i]);
    logic integer span_steps(struct motion_plan *plan, integer section) =
        section == plan->first ?
            begin_of(&plan->order, section) + plan->order.section[section].steps - plan->origin.step :
            plan->order.section[section].steps;
    logic integer span_begin(struct motion_plan *plan, integer section) =
        section == plan->first ? plan->origin.step : begin_of(&plan->order, section);
    logic integer span_gain(struct motion_plan *plan, integer section) =
        gain_of(plan->order.section[section].accel_steps_per_s2, span_steps(plan, section));
    logic integer full_gain(struct motion_order *order, integer section) =
        gain_of(order->section[section].accel_steps_per_s2, order->section[section].steps);
    logic integer enter_of(struct motion_plan *plan, integer section) =
        section == plan->first ? plan->origin.speed2 : plan->exit_speed2[section - 1];
*/

/* Squares of speeds: of a section's limit, and of what follows it; borders as the look backward leaves them. */
/*@ logic integer limit_of(struct motion_order *order, integer i) = square_of(order->section[i].speed_steps_per_s);
    logic integer start_of(struct motion_order *order) = square_of(order->start_speed_steps_per_s);
    logic integer next_limit(struct motion_order *order, integer i) =
        i + 1 == order->sections ? start_of(order) : limit_of(order, i + 1);
    predicate is_backed(struct motion_plan *plan, integer i) =
        speed2_in_range(plan->exit_speed2[i]) && plan->exit_speed2[i] <= limit_of(&plan->order, i) &&
        plan->exit_speed2[i] <= next_limit(&plan->order, i) &&
        (i + 1 < plan->order.sections ==>
            plan->exit_speed2[i] <= plan->exit_speed2[i + 1] + full_gain(&plan->order, i + 1));
*/

/* With which square of the speed a section may be left: with one from which each section that follows can brake to its
 * limit, and the last to S. It is said with what all sections before a border could gain; nothing of it depends on the
 * section itself, on those before it or on exit speeds. */
/*@ logic integer gained_in(struct motion_order *order, integer section, integer place) =
        place < section ? full_gain(order, place) : 0;
    logic integer gained_to(struct motion_order *order, integer section) =
        gained_in(order, section, 0) + gained_in(order, section, 1) + gained_in(order, section, 2) +
        gained_in(order, section, 3) + gained_in(order, section, 4) + gained_in(order, section, 5) +
        gained_in(order, section, 6) + gained_in(order, section, 7) + gained_in(order, section, 8) +
        gained_in(order, section, 9);
    predicate can_leave(struct motion_order *order, integer i, integer speed2) =
        speed2 + gained_to(order, i + 1) <= start_of(order) + gained_to(order, order->sections) &&
        \forall integer k; i < k < order->sections ==>
            speed2 + gained_to(order, i + 1) <= limit_of(order, k) + gained_to(order, k);
*/

/* The conditions of a profile. */
/*@ logic integer jumps_of(struct motion_plan *plan, integer i) =
        plan->kind == MOTION_PLAN_CHANGED && i == plan->first ? 1 : 0;
    predicate is_reached(struct motion_plan *plan, integer i) =
        in_reach(jumps_of(plan, i), enter_of(plan, i), plan->exit_speed2[i], limit_of(&plan->order, i),
            start_of(&plan->order), span_gain(plan, i));
    predicate is_fitted(struct motion_plan *plan) =
        \forall integer i; plan->first <= i < plan->order.sections ==> is_reached(plan, i);
    predicate fits_next(struct motion_plan *plan, integer i, integer speed2) =
        speed2 <= next_limit(&plan->order, i) &&
        (i + 1 < plan->order.sections ==> speed2 <= plan->exit_speed2[i + 1] + full_gain(&plan->order, i + 1));
    predicate can_begin(struct motion_plan *plan, integer i, integer enter, integer gain) =
        plan->kind == MOTION_PLAN_CHANGED ?
            enter - gain <= plan->exit_speed2[i] ||
                (plan->exit_speed2[i] == limit_of(&plan->order, i) && fits_next(plan, i, enter - gain)) :
            enter <= limit_of(&plan->order, i) && enter - gain <= plan->exit_speed2[i];
    predicate is_highest(struct motion_plan *plan, integer i) =
        \forall integer speed2; can_leave(&plan->order, i, speed2) ==> fits_next(plan, i, speed2) &&
            (speed2 <= plan->exit_speed2[i] || plan->exit_speed2[i] == limit_of(&plan->order, i));
    predicate can_leave_all(struct motion_plan *plan) =
        \forall integer i; plan->first <= i < plan->order.sections ==>
            can_leave(&plan->order, i, plan->exit_speed2[i]);
*/

/* What a plan keeps between two places of the code. */
/*@ predicate keeps_steps{A, B}(struct motion_order *order) =
        \forall integer k; 0 <= k < MOTION_SECTIONS ==>
            \at(order->section[k].steps, A) == \at(order->section[k].steps, B);
    predicate keeps_accel{A, B}(struct motion_order *order) =
        \forall integer k; 0 <= k < MOTION_SECTIONS ==>
            \at(order->section[k].accel_steps_per_s2, A) == \at(order->section[k].accel_steps_per_s2, B);
    predicate keeps_speeds{A, B}(struct motion_order *order) =
        \forall integer k; 0 <= k < MOTION_SECTIONS ==>
            \at(order->section[k].speed_steps_per_s, A) == \at(order->section[k].speed_steps_per_s, B);
    predicate keeps_order{A, B}(struct motion_order *order) =
        \at(order->sections, A) == \at(order->sections, B) &&
        \at(order->start_speed_steps_per_s, A) == \at(order->start_speed_steps_per_s, B) &&
        keeps_steps{A, B}(order) && keeps_accel{A, B}(order) && keeps_speeds{A, B}(order);
    predicate keeps_exits{A, B}(struct motion_plan *plan) =
        \forall integer k; 0 <= k < MOTION_SECTIONS ==> \at(plan->exit_speed2[k], A) == \at(plan->exit_speed2[k], B);
    predicate keeps_origin{A, B}(struct motion_plan *plan) =
        \at(plan->first, A) == \at(plan->first, B) && \at(plan->kind, A) == \at(plan->kind, B) &&
        \at(plan->origin.time.ticks, A) == \at(plan->origin.time.ticks, B) &&
        \at(plan->origin.time.fraction, A) == \at(plan->origin.time.fraction, B) &&
        \at(plan->origin.step, A) == \at(plan->origin.step, B) &&
        \at(plan->origin.speed2, A) == \at(plan->origin.speed2, B);
*/

/*@ requires \valid_read(plan) && is_order(&plan->order) && section <= plan->order.sections;
    assigns \nothing;
    ensures \result == begin_of(&plan->order, section) && \result <= 10 * MOTION_ENDLESS_STEPS;
*/
uint64_t motion_plan_section_begin(const struct motion_plan *plan, unsigned section);

/*@ requires \valid_read(plan) && is_plan(plan) && plan->first <= section < plan->order.sections;
    assigns \nothing;
    ensures \result.steps == span_steps(plan, section) && 1 <= \result.steps <= MOTION_ENDLESS_STEPS;
    ensures \result.accel_steps_per_s2 == plan->order.section[section].accel_steps_per_s2;
    ensures \result.speed_steps_per_s == plan->order.section[section].speed_steps_per_s;
    ensures \result.start_speed_steps_per_s == plan->order.start_speed_steps_per_s;
    ensures speed_in_range(\result.speed_steps_per_s) && speed_in_range(\result.start_speed_steps_per_s);
    ensures 1 <= \result.accel_steps_per_s2 <= STEP_ACCEL_MAX;
    ensures \result.begin == span_begin(plan, section) && \result.begin <= 10 * MOTION_ENDLESS_STEPS;
    ensures \result.jumps == jumps_of(plan, section);
    ensures \result.enter_speed2 == enter_speed2 && \result.exit_speed2 == plan->exit_speed2[section];
*/
struct motion_span motion_plan_section_span(const struct motion_plan *plan, unsigned section, uint64_t enter_speed2);

/*@ requires \valid_read(plan) && is_order(&plan->order) && section < plan->order.sections;
    requires speed2_in_range(plan->exit_speed2[section]);
    assigns \nothing;
    ensures \result == plan->exit_speed2[section] + full_gain(&plan->order, section);
    ensures \result >= plan->exit_speed2[section];
*/
uint64_t motion_lookahead_brakeable(const struct motion_plan *plan, unsigned section);

/*@ requires \valid(plan) && is_order(&plan->order) && plan->first < plan->order.sections;
    assigns plan->exit_speed2[plan->first .. plan->order.sections - 1];
    ensures \forall integer i; plan->first <= i < plan->order.sections ==> is_backed(plan, i);
    ensures \forall integer i; plan->first <= i < plan->order.sections ==> is_highest(plan, i);
    ensures can_leave_all(plan);
    ensures keeps_order{Old, Post}(&plan->order) && keeps_origin{Old, Post}(plan);
*/
void motion_lookahead_backward(struct motion_plan *plan);

/*@ requires \valid(plan) && is_plan(plan);
    requires \forall integer i; plan->first <= i < plan->order.sections ==> is_backed(plan, i);
    requires can_begin(plan, plan->first, plan->origin.speed2, span_gain(plan, plan->first));
    requires can_leave(&plan->order, plan->first, plan->origin.speed2 - span_gain(plan, plan->first));
    requires can_leave_all(plan);
    assigns plan->exit_speed2[plan->first .. plan->order.sections - 1];
    ensures has_exits(plan) && is_fitted(plan);
    ensures can_leave_all(plan);
    ensures keeps_order{Old, Post}(&plan->order) && keeps_origin{Old, Post}(plan);
    ensures is_plan(plan);
    ensures can_leave(&plan->order, plan->first, plan->origin.speed2 - span_gain(plan, plan->first));
*/
void motion_lookahead_forward(struct motion_plan *plan);

#endif
