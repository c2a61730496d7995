/*
 * What motion_plan_begin, _stop and _change_speed leave behind, and what motion_plan_next begins with.
 */
#ifndef READY_H
#define READY_H

#include "plans.h"

/*@ predicate is_braked(struct motion_plan *plan) =
        \forall integer i; plan->first <= i < plan->order.sections ==>
            speed2_in_range(plan->exit_speed2[i]) && plan->exit_speed2[i] <= enter_of(plan, i) &&
            enter_of(plan, i) - plan->exit_speed2[i] <= way_gain(plan, i);
    predicate is_ready(struct motion_plan *plan) =
        plan->first <= plan->order.sections <= MOTION_SECTIONS &&
        (plan->first < plan->order.sections ==>
            is_plan(plan) && has_exits(plan) && (plan->stopping ? is_braked(plan) : is_laid(plan)));
    predicate is_rewound(struct motion_plan *plan) =
        plan->progress.time.ticks == plan->origin.time.ticks &&
        plan->progress.time.fraction == plan->origin.time.fraction &&
        plan->progress.place.step == plan->origin.step && plan->progress.place.quanta == 0 &&
        plan->progress.twice_speed2 == 0 && plan->progress.slope == 0 &&
        plan->progress.section == plan->first && plan->progress.leg == 0;
*/

#endif
