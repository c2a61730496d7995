/*
 * The next leg is made without a change of the plan, but for the slope that it knows.
 * Contract proved with motion_legs_next.acsl.
 */
#ifndef MADE_NEXT_H
#define MADE_NEXT_H

#include "kept_progress.h"
#include "made_legs.h"

/*@ requires \valid(plan) && \valid(leg) && \base_addr(plan) != \base_addr(leg);
    requires knows_slope(&plan->progress) && has_leg(&plan->progress);
    requires !is_at_end(plan->progress.leg, plan->progress.profile, plan->progress.place);
    requires plan->progress.time.ticks < 0x8000000000000000;
    assigns plan->progress.twice_speed2, plan->progress.slope, *leg;
    ensures known: knows_slope(&plan->progress);
    ensures made: is_leg_made(*leg);
    ensures begins: begins_at(*leg, \old(plan->progress.place));
    ensures pulses: has_pulses(leg->from, leg->to);
    ensures lasts: lasts_from(*leg, \old(plan->progress.time.ticks));
    ensures ends: ends_well(\old(plan->progress.leg), *leg, \old(plan->progress.profile));
    ENSURES_PLAN_KEPT(plan)
*/
static void make_next_leg(struct motion_plan *plan, struct motion_leg *leg);

#endif
