/*
 * How far segments have been taken from a plan, and that each leg begins where the one before it ends: contracts proved with
 * motion_plan_advance.acsl and motion_plan_next.acsl.
 */
#ifndef UNDER_WAY_H
#define UNDER_WAY_H

#include "sections.h"
#include "laid_legs.h"

/* The progress stands on a leg of its section's profile, or at the beginning of a section that has none yet. */
/*@ predicate has_profile(struct motion_plan *plan, integer section) =
        plan->stopping ? is_stop_of(plan->progress.profile, way_begin(plan, section)) &&
            (section + 1 < plan->order.sections ==>
                is_step(plan->progress.profile.corner_a, begin_of(&plan->order, section + 1))) :
            is_profile_of(plan->progress.profile, way_begin(plan, section), begin_of(&plan->order, section + 1));
    predicate is_at_begin(struct motion_plan *plan) =
        plan->progress.leg == 0 && is_step(plan->progress.place, way_begin(plan, plan->progress.section));
    predicate is_between(struct motion_plan *plan) =
        plan->progress.leg >= 1 && !plan->stopping && is_place(plan->progress.place) &&
        quanta(plan->progress.profile.corner_a) <= quanta(plan->progress.place) &&
        quanta(plan->progress.place) <= quanta(plan->progress.profile.corner_b) &&
        (plan->progress.leg == 2 ==> is_same(plan->progress.place, plan->progress.profile.corner_b));
    predicate is_placed(struct motion_plan *plan) =
        plan->progress.leg <= 2 && (is_at_begin(plan) || is_between(plan));
    predicate has_laid(struct motion_plan *plan) =
        has_profile(plan, plan->progress.section) && has_short_ramps(plan->progress.profile);
    predicate goes_on(struct motion_plan *plan) =
        plan->first <= plan->progress.section <= plan->order.sections && plan->progress.leg <= 2 &&
        (plan->progress.section < plan->order.sections ==>
            is_at_begin(plan) || (is_between(plan) && has_laid(plan)));
    predicate is_under_way(struct motion_plan *plan) =
        is_ready(plan) && is_short_ramped(plan) && knows_slope(&plan->progress) && goes_on(plan);
    logic integer legs_left(struct motion_plan *plan) =
        3 * (plan->order.sections - plan->progress.section) - plan->progress.leg;
*/

/*@ predicate has_steps(struct step_segment segment) = 1 <= segment.steps <= 0xFFFFFFFF; */

/* What a profile keeps between two places of the code. */
/*@ predicate keeps_profile{A, B}(struct motion_plan *plan) =
        \at(plan->progress.profile.enter, A) == \at(plan->progress.profile.enter, B) &&
        \at(plan->progress.profile.turn, A) == \at(plan->progress.profile.turn, B) &&
        \at(plan->progress.profile.cruise, A) == \at(plan->progress.profile.cruise, B) &&
        \at(plan->progress.profile.exit, A) == \at(plan->progress.profile.exit, B) &&
        \at(plan->progress.profile.begin, A) == \at(plan->progress.profile.begin, B) &&
        \at(plan->progress.profile.end, A) == \at(plan->progress.profile.end, B) &&
        \at(plan->progress.profile.accel_steps_per_s2, A) == \at(plan->progress.profile.accel_steps_per_s2, B) &&
        \at(plan->progress.profile.corner_a.step, A) == \at(plan->progress.profile.corner_a.step, B) &&
        \at(plan->progress.profile.corner_a.quanta, A) == \at(plan->progress.profile.corner_a.quanta, B) &&
        \at(plan->progress.profile.corner_b.step, A) == \at(plan->progress.profile.corner_b.step, B) &&
        \at(plan->progress.profile.corner_b.quanta, A) == \at(plan->progress.profile.corner_b.quanta, B);
    predicate keeps_plan{A, B}(struct motion_plan *plan) =
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan);
    predicate keeps_slope{A, B}(struct motion_plan *plan) =
        \at(plan->progress.slope, A) == \at(plan->progress.slope, B) &&
        \at(plan->progress.twice_speed2, A) == \at(plan->progress.twice_speed2, B);
*/

/*@ requires \valid(plan) && is_ready(plan) && plan->first <= plan->progress.section < plan->order.sections;
    requires has_laid(plan) && plan->progress.leg <= 2 && (plan->progress.leg >= 1 ==> !plan->stopping);
    requires is_at_end(plan->progress.leg, plan->progress.profile, plan->progress.place);
    assigns plan->progress.leg, plan->progress.section;
    ensures goes_on: goes_on(plan);
    ensures plan_kept: keeps_plan{Old, Post}(plan);
    ensures slope_kept: keeps_slope{Old, Post}(plan);
    ensures left: legs_left(plan) < \old(legs_left(plan));
*/
static void next_leg(struct motion_plan *plan);

/*@ requires \valid(plan) && \valid_read(leg) && \separated(plan, leg);
    requires is_ready(plan) && plan->first <= plan->progress.section < plan->order.sections;
    requires has_laid(plan) && is_placed(plan);
    requires begins_at(*leg, plan->progress.place);
    requires ends_well(plan->progress.leg, *leg, plan->progress.profile);
    assigns plan->progress.time, plan->progress.place, plan->progress.leg, plan->progress.section;
    ensures goes_on: goes_on(plan);
    ensures plan_kept: keeps_plan{Old, Post}(plan);
    ensures slope_kept: keeps_slope{Old, Post}(plan);
    ensures leg_kept: *leg == \old(*leg);
    ensures time: \forall integer start; lasts_from(\old(*leg), start) ==>
        plan->progress.time.ticks <= start + leg_ticks_max;
    ensures left: has_no_pulse(\old(*leg)) ==> legs_left(plan) < \old(legs_left(plan));
*/
static void advance(struct motion_plan *plan, const struct motion_leg *leg);

/*@ requires \valid_read(plan) && is_order(&plan->order);
    assigns \nothing;
*/
static bool is_mark(const struct motion_plan *plan);

/*@ requires \valid(plan) && \valid(segment) && \separated(plan, segment);
    requires is_under_way(plan);
    requires plan->progress.time.ticks < 0x4000000000000000;
    assigns plan->progress, *segment;
    ensures is_under_way(plan);
    ensures \result ==> has_steps(*segment);
    ensures !\result ==> plan->progress.section == plan->order.sections;
*/
bool motion_plan_next(struct motion_plan *plan, struct step_segment *segment);

#endif
