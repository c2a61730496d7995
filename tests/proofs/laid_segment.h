/*
 * A segment is laid without a change of the plan. Contract proved with motion_plan_segment.acsl.
 */
#ifndef LAID_SEGMENT_H
#define LAID_SEGMENT_H

#include "kept_progress.h"
#include "legs.h"

/*@ requires \valid_read(plan) && \valid_read(leg) && \valid(segment);
    requires \base_addr(plan) != \base_addr(segment) && \base_addr(leg) != \base_addr(segment);
    requires is_order(&plan->order) && is_leg(leg) && is_timed(leg);
    requires 1 <= leg->to.step - leg->from.step <= 0xFFFFFFFF;
    assigns *segment;
    ensures pulses: segment->steps == \old(leg->to.step - leg->from.step);
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
    ensures is_same64{Old, Post}(&plan->progress.slope);
    ensures is_same64{Old, Post}(&plan->progress.twice_speed2);
    ensures time: plan->progress.time.ticks == \old(plan->progress.time.ticks);
*/
static void lay_segment(const struct motion_plan *plan, const struct motion_leg *leg, struct step_segment *segment);

#endif
