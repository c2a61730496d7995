/*
 * A segment is made without a change of the plan. Contract proved with motion_legs_segment.acsl.
 */
#ifndef MADE_SEGMENT_H
#define MADE_SEGMENT_H

#include "kept_progress.h"
#include "legs.h"

/*@ requires \valid_read(plan) && \valid_read(leg) && \valid(segment);
    requires \base_addr(plan) != \base_addr(segment) && \base_addr(leg) != \base_addr(segment);
    requires is_order(&plan->order) && is_leg(leg) && is_timed(leg);
    requires 1 <= leg->to.step - leg->from.step <= 0xFFFFFFFF;
    assigns *segment;
    ensures pulses: segment->steps == \old(leg->to.step - leg->from.step);
    ENSURES_PLAN_KEPT(plan)
    SLOPE_CELLS(ENSURES_SAME, plan)
*/
static void make_segment(const struct motion_plan *plan, const struct motion_leg *leg, struct step_segment *segment);

#endif
