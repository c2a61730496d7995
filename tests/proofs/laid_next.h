/*
 * The next leg is laid without a change of the plan, but for the slope that it knows.
 * Contract proved with motion_plan_lay.acsl.
 */
#ifndef LAID_NEXT_H
#define LAID_NEXT_H

#include "kept_progress.h"
#include "laid_legs.h"

/*@ requires \valid(plan) && \valid(leg) && \base_addr(plan) != \base_addr(leg);
    requires knows_slope(&plan->progress) && has_leg(&plan->progress);
    requires !is_at_end(plan->progress.leg, plan->progress.profile, plan->progress.place);
    requires plan->progress.time.ticks < 0x8000000000000000;
    assigns plan->progress.twice_speed2, plan->progress.slope, *leg;
    ensures known: knows_slope(&plan->progress);
    ensures laid: is_leg_laid(*leg);
    ensures begins: begins_at(*leg, \old(plan->progress.place));
    ensures pulses: has_pulses(leg->from, leg->to);
    ensures lasts: lasts_from(*leg, \old(plan->progress.time.ticks));
    ensures ends: ends_well(\old(plan->progress.leg), *leg, \old(plan->progress.profile));
    ensures keeps_steps{Old, Post}(&plan->order);
    ensures keeps_accel{Old, Post}(&plan->order);
    ensures keeps_speeds{Old, Post}(&plan->order);
    ensures keeps_exits{Old, Post}(plan);
    ensures is_same32{Old, Post}(&plan->order.start_speed_steps_per_s);
    ensures is_same64{Old, Post}(&plan->origin.time.ticks);
    ensures is_same32{Old, Post}(&plan->origin.time.fraction);
    ensures is_same64{Old, Post}(&plan->origin.step);
    ensures is_same64{Old, Post}(&plan->origin.speed2);
    ensures is_same_flag{Old, Post}(&plan->changed);
    ensures is_same_flag{Old, Post}(&plan->stopping);
    ensures is_same64{Old, Post}(&plan->progress.profile.enter);
    ensures is_same64{Old, Post}(&plan->progress.profile.turn);
    ensures is_same64{Old, Post}(&plan->progress.profile.cruise);
    ensures is_same64{Old, Post}(&plan->progress.profile.exit);
    ensures is_same64{Old, Post}(&plan->progress.profile.begin);
    ensures is_same64{Old, Post}(&plan->progress.profile.end);
    ensures is_same64{Old, Post}(&plan->progress.profile.corner_a.step);
    ensures is_same64{Old, Post}(&plan->progress.profile.corner_a.quanta);
    ensures is_same64{Old, Post}(&plan->progress.profile.corner_b.step);
    ensures is_same64{Old, Post}(&plan->progress.profile.corner_b.quanta);
    ensures is_same32{Old, Post}(&plan->progress.profile.accel_steps_per_s2);
    ensures is_same64{Old, Post}(&plan->progress.place.step);
    ensures is_same64{Old, Post}(&plan->progress.place.quanta);
    ensures time: plan->progress.time.ticks == \old(plan->progress.time.ticks);
*/
static void lay_next_leg(struct motion_plan *plan, struct motion_leg *leg);

#endif
