/*
 * What motion_plan_begin, _stop and _change_speed leave, and what motion_plan_next begins with.
 */
#ifndef READY_H
#define READY_H

#include "plans.h"

/*@ predicate is_braked_at(struct motion_plan *plan, integer i) =
        speed2_in_range(plan->exit_speed2[i]) && plan->exit_speed2[i] <= enter_of(plan, i) &&
        enter_of(plan, i) - plan->exit_speed2[i] <= span_gain(plan, i);
    predicate is_braked_through(struct motion_plan *plan, integer i) =
        enter_of(plan, i) - plan->exit_speed2[i] == span_gain(plan, i) &&
        plan->exit_speed2[i] <= limit_of(&plan->order, i + 1);
    predicate is_braked_all(struct motion_plan *plan) =
        \forall integer i; plan->first <= i < plan->order.sections ==> is_braked_at(plan, i);
    predicate is_braked(struct motion_plan *plan) = is_braked_all(plan) &&
        \forall integer i; plan->first <= i < plan->order.sections - 1 ==> is_braked_through(plan, i);
    predicate is_ready(struct motion_plan *plan) =
        plan->first <= plan->order.sections <= MOTION_SECTIONS &&
        (plan->first < plan->order.sections ==>
            is_plan(plan) && has_exits(plan) && (plan->kind == MOTION_PLAN_STOP ? is_braked(plan) : is_fitted(plan)));
    predicate lies_on(struct motion_order *order, integer step, integer speed2) =
        speed2_in_range(speed2) && \forall integer i; 0 <= i < order->sections &&
            begin_of(order, i) <= step < begin_of(order, i) + order->section[i].steps ==>
                can_leave(order, i, speed2 - gain_of(order->section[i].accel_steps_per_s2,
                    begin_of(order, i) + order->section[i].steps - step));
    predicate is_rewound_to(struct motion_plan *plan, integer ticks, integer fraction, integer step, integer section) =
        plan->progress.time.ticks == ticks && plan->progress.time.fraction == fraction &&
        plan->progress.place.step == step && plan->progress.place.quanta == 0 &&
        plan->progress.twice_speed2 == 0 && plan->progress.slope == 0 &&
        plan->progress.section == section && plan->progress.leg == 0;
    predicate is_rewound(struct motion_plan *plan) =
        is_rewound_to(plan, plan->origin.time.ticks, plan->origin.time.fraction, plan->origin.step, plan->first);
*/

/*@ requires \valid(plan);
    assigns plan->progress;
    ensures rewound_to: is_rewound_to(plan, \old(plan->origin.time.ticks), \old(plan->origin.time.fraction),
        \old(plan->origin.step), \old(plan->first));
    ensures kept: keeps_order{Old, Post}(&plan->order) && keeps_origin{Old, Post}(plan) && keeps_exits{Old, Post}(plan);
    ensures kept_rewound: is_rewound_to(plan, \old(plan->origin.time.ticks), \old(plan->origin.time.fraction),
        \old(plan->origin.step), \old(plan->first)) ==> is_rewound(plan);
    ensures kept_ready: \old(is_ready(plan)) ==> is_ready(plan);
    ensures kept_plan: \old(is_plan(plan)) ==> is_plan(plan);
    ensures kept_left: \old(is_plan(plan) && can_leave_all(plan)) ==> can_leave_all(plan);
    ensures kept_leaves: \old(is_plan(plan) && can_leave(&plan->order, plan->first,
        plan->origin.speed2 - span_gain(plan, plan->first))) ==>
            can_leave(&plan->order, plan->first, plan->origin.speed2 - span_gain(plan, plan->first));
*/
void motion_plan_rewind(struct motion_plan *plan);

/*@ requires \valid(plan) && \valid_read(order) && \separated(plan, order) && is_order(order);
    assigns *plan;
    ensures is_ready(plan) && is_rewound(plan) && is_plan(plan);
    ensures can_leave_all(plan);
    ensures can_leave(&plan->order, plan->first, plan->origin.speed2 - span_gain(plan, plan->first));
    ensures is_order(&plan->order) && plan->kind == MOTION_PLAN_ORDERED && plan->first == 0;
    ensures plan->origin.time.ticks == start_tick && plan->origin.time.fraction == 0 && plan->origin.step == 0;
    ensures plan->begin_speed2 == plan->origin.speed2 && speed2_in_range(plan->begin_speed2);
*/
void motion_plan_begin(struct motion_plan *plan, const struct motion_order *order, uint64_t start_tick);

/*@ requires \valid(plan) && \valid_read(at) && \separated(plan, at) && has_order(plan);
    requires lies_on(&plan->order, at->step, at->speed2);
    assigns *plan;
    ensures \result <==> \old(at->step < begin_of(&plan->order, plan->order.sections));
    ensures !\result ==> *plan == \old(*plan);
    ensures \result ==> is_ready(plan);
    ensures \result ==> is_rewound(plan);
    ensures \result ==> plan->kind == MOTION_PLAN_STOP && plan->order.sections <= \old(plan->order.sections);
    ensures \result ==> plan->origin.step == \old(at->step) && plan->origin.speed2 == \old(at->speed2);
    ensures plan->begin_speed2 == \old(plan->begin_speed2);
*/
bool motion_plan_stop(struct motion_plan *plan, const struct motion_point *at);

/*@ requires \valid(plan) && \valid_read(at) && \separated(plan, at) && has_order(plan);
    requires lies_on(&plan->order, at->step, at->speed2) && speed_in_range(speed_steps_per_s);
    assigns *plan;
    ensures \result <==> \old(at->step < begin_of(&plan->order, plan->order.sections));
    ensures !\result ==> *plan == \old(*plan);
    ensures \result ==> is_ready(plan) && is_rewound(plan) && is_plan(plan);
    ensures \result ==> can_leave_all(plan);
    ensures \result ==> can_leave(&plan->order, plan->first, plan->origin.speed2 - span_gain(plan, plan->first));
    ensures \result ==> plan->kind == MOTION_PLAN_CHANGED && plan->order.sections == \old(plan->order.sections);
    ensures \result ==> plan->origin.step == \old(at->step) && plan->origin.speed2 == \old(at->speed2);
    ensures plan->begin_speed2 == \old(plan->begin_speed2);
*/
bool motion_plan_change_speed(struct motion_plan *plan, const struct motion_point *at, uint32_t speed_steps_per_s);

#endif
