/*
 * Contracts of what motion_replan.c keeps for itself: proved with motion_replan.acsl and motion_replan_brake.acsl.
 */
#ifndef REPLANS_H
#define REPLANS_H

#include "ready.h"

/*@ requires \valid_read(plan) && has_order(plan);
    assigns \nothing;
    ensures \result <= plan->order.sections;
    ensures \result == plan->order.sections <==> begin_of(&plan->order, plan->order.sections) <= step;
    ensures \result < plan->order.sections ==> begin_of(&plan->order, \result) <= step <
        begin_of(&plan->order, \result) + plan->order.section[\result].steps;
*/
static unsigned section_after(const struct motion_plan *plan, uint64_t step);

/*@ requires \valid(plan) && is_plan(plan);
    requires can_leave(&plan->order, plan->first, plan->origin.speed2 - span_gain(plan, plan->first));
    assigns plan->exit_speed2[plan->first .. plan->order.sections - 1], plan->order.sections;
    ensures plan->first <= plan->order.sections <= \old(plan->order.sections);
    ensures plan->first < plan->order.sections ==> is_plan(plan) && has_exits(plan) && is_braked(plan);
*/
static void plan_brake(struct motion_plan *plan);

#endif
