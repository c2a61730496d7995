/*
 * What is kept with a plan and its progress: that segments can go on to be taken from it.
 */
#ifndef UNDER_WAY_KEPT_H
#define UNDER_WAY_KEPT_H

#include "kept.h"
#include "under_way.h"

/*@ lemma keeps_limit{A, B}: \forall struct motion_order *order, integer i;
        keeps_speeds{A, B}(order) && 0 <= i < MOTION_SECTIONS ==> limit_of{A}(order, i) == limit_of{B}(order, i);
    lemma keeps_short_in{A, B}: \forall struct motion_order *order, integer i, speed2;
        keeps_accel{A, B}(order) && 0 <= i < MOTION_SECTIONS && is_short_in{A}(order, i, speed2) ==>
            is_short_in{B}(order, i, speed2);
    lemma keeps_short_at{A, B}: \forall struct motion_plan *plan, integer i;
        keeps_plan{A, B}(plan) && 0 <= \at(plan->first, A) <= i < MOTION_SECTIONS && is_short_ramped_at{A}(plan, i) ==>
            is_short_ramped_at{B}(plan, i);
    lemma keeps_short{A, B}: \forall struct motion_plan *plan;
        keeps_plan{A, B}(plan) && 0 <= \at(plan->first, A) && \at(plan->order.sections, A) <= MOTION_SECTIONS &&
        is_short_ramped{A}(plan) ==> is_short_ramped{B}(plan);
    lemma keeps_known{A, B}: \forall struct motion_plan *plan;
        keeps_slope{A, B}(plan) && knows_slope{A}(\at(&plan->progress, A)) ==>
            knows_slope{B}(\at(&plan->progress, B));
    lemma keeps_going{A, B}: \forall struct motion_plan *plan;
        keeps_plan{A, B}(plan) && keeps_profile{A, B}(plan) && keeps_place{A, B}(plan) &&
        0 <= \at(plan->first, A) && \at(plan->order.sections, A) <= MOTION_SECTIONS &&
        goes_on{A}(plan) ==> goes_on{B}(plan);
    lemma leg_of: \forall struct motion_plan *plan; has_fitted(plan) && is_placed(plan) && 0 <= plan->progress.leg ==>
        has_leg(&plan->progress);
    lemma leg_order: \forall struct motion_leg *leg; is_leg_made(*leg) ==> leg->from.step <= leg->to.step;
    lemma keeps_ready_plan{A, B}: \forall struct motion_plan *plan;
        keeps_plan{A, B}(plan) && 0 <= \at(plan->first, A) && is_ready{A}(plan) ==> is_ready{B}(plan);
    lemma rewound: \forall struct motion_plan *plan;
        is_ready(plan) && is_short_ramped(plan) && is_rewound(plan) ==> is_under_way(plan);
*/
#define ALSO_SAME(type, cell) && is_same##type{A, B}(\at(cell, A))

/*@ lemma same_origin{A, B}: \forall struct motion_plan *plan;
        \at(plan->first, A) == \at(plan->first, B) ORIGIN_CELLS(ALSO_SAME, plan) ==> keeps_origin{A, B}(plan);
    lemma same_profile{A, B}: \forall struct motion_plan *plan;
        \true PROFILE_CELLS(ALSO_SAME, plan) ==> keeps_profile{A, B}(plan);
    lemma same_place{A, B}: \forall struct motion_plan *plan;
        \at(plan->progress.leg, A) == \at(plan->progress.leg, B) &&
        \at(plan->progress.section, A) == \at(plan->progress.section, B) PLACE_CELLS(ALSO_SAME, plan) ==>
            keeps_place{A, B}(plan);
    lemma same_slope{A, B}: \forall struct motion_plan *plan;
        \true SLOPE_CELLS(ALSO_SAME, plan) ==> keeps_slope{A, B}(plan);
    lemma same_order{A, B}: \forall struct motion_order *order;
        \at(order->sections, A) == \at(order->sections, B) &&
        is_same32{A, B}(\at(&order->start_speed_steps_per_s, A)) &&
        keeps_steps{A, B}(order) && keeps_accel{A, B}(order) && keeps_speeds{A, B}(order) ==>
            keeps_order{A, B}(order);
*/

#endif
