/*
 * What is kept with an order, an origin and exit speeds: gains, the speeds that a section may be left with, and whether
 * segments can be taken.
 */
#ifndef KEPT_H
#define KEPT_H

#include "ready.h"

/*@ lemma keeps_begin{A, B}: \forall struct motion_order *order, integer i; keeps_steps{A, B}(order) ==>
        begin_of{A}(order, i) == begin_of{B}(order, i);
    lemma keeps_full{A, B}: \forall struct motion_order *order, integer i;
        keeps_steps{A, B}(order) && keeps_accel{A, B}(order) && 0 <= i < MOTION_SECTIONS ==>
            full_gain{A}(order, i) == full_gain{B}(order, i);
    lemma keeps_gained{A, B}: \forall struct motion_order *order, integer i;
        keeps_steps{A, B}(order) && keeps_accel{A, B}(order) ==> gained_to{A}(order, i) == gained_to{B}(order, i);
    lemma keeps_leave{A, B}: \forall struct motion_order *order, integer i, speed2;
        keeps_order{A, B}(order) && 0 <= i && \at(order->sections, A) <= MOTION_SECTIONS &&
        can_leave{A}(order, i, speed2) ==> can_leave{B}(order, i, speed2);
    lemma keeps_is_order{A, B}: \forall struct motion_order *order;
        keeps_order{A, B}(order) && is_order{A}(order) ==> is_order{B}(order);
    lemma keeps_plan{A, B}: \forall struct motion_plan *plan;
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_origin{A, B}(plan) && is_plan{A}(plan) ==> is_plan{B}(plan);
    lemma keeps_span{A, B}: \forall struct motion_plan *plan, integer i;
        keeps_steps{A, B}(\at(&plan->order, A)) && keeps_accel{A, B}(\at(&plan->order, A)) &&
            keeps_origin{A, B}(plan) &&
        0 <= i < MOTION_SECTIONS ==> span_gain{A}(plan, i) == span_gain{B}(plan, i);
    lemma keeps_leave_all{A, B}: \forall struct motion_plan *plan;
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan) &&
        0 <= \at(plan->first, A) && \at(plan->order.sections, A) <= MOTION_SECTIONS &&
        can_leave_all{A}(plan) ==> can_leave_all{B}(plan);
    lemma keeps_backed{A, B}: \forall struct motion_plan *plan, integer i;
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_exits{A, B}(plan) && 0 <= i < \at(plan->order.sections, A) <=
        MOTION_SECTIONS && is_backed{A}(plan, i) ==> is_backed{B}(plan, i);
    lemma keeps_enter{A, B}: \forall struct motion_plan *plan, integer i;
        keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan) && 0 <= \at(plan->first, A) <= i < MOTION_SECTIONS ==>
            enter_of{A}(plan, i) == enter_of{B}(plan, i);
    lemma keeps_has_exits{A, B}: \forall struct motion_plan *plan;
        \at(plan->order.sections, A) == \at(plan->order.sections, B) <= MOTION_SECTIONS && 0 <= \at(plan->first, A) &&
        keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan) && has_exits{A}(plan) ==> has_exits{B}(plan);
    lemma keeps_braked_all{A, B}: \forall struct motion_plan *plan;
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan) &&
        0 <= \at(plan->first, A) && \at(plan->order.sections, A) <= MOTION_SECTIONS &&
        is_braked_all{A}(plan) ==> is_braked_all{B}(plan);
    lemma keeps_braked_through{A, B}: \forall struct motion_plan *plan, integer i;
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan) &&
        0 <= \at(plan->first, A) <= i < MOTION_SECTIONS - 1 &&
        is_braked_through{A}(plan, i) ==> is_braked_through{B}(plan, i);
    lemma keeps_braked{A, B}: \forall struct motion_plan *plan;
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan) &&
        0 <= \at(plan->first, A) && \at(plan->order.sections, A) <= MOTION_SECTIONS &&
        is_braked{A}(plan) ==> is_braked{B}(plan);
    lemma keeps_reached{A, B}: \forall struct motion_plan *plan, integer i;
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan) &&
        0 <= \at(plan->first, A) <= i < MOTION_SECTIONS &&
        is_reached{A}(plan, i) ==> is_reached{B}(plan, i);
    lemma keeps_fitted{A, B}: \forall struct motion_plan *plan;
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan) &&
        0 <= \at(plan->first, A) && \at(plan->order.sections, A) <= MOTION_SECTIONS &&
        is_fitted{A}(plan) ==> is_fitted{B}(plan);
    lemma keeps_ready{A, B}: \forall struct motion_plan *plan;
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan) &&
        0 <= \at(plan->first, A) && is_ready{A}(plan) ==> is_ready{B}(plan);
    lemma fitted_is_ready: \forall struct motion_plan *plan;
        is_plan(plan) && has_exits(plan) && is_fitted(plan) && plan->kind != MOTION_PLAN_STOP ==> is_ready(plan);
*/

#endif
