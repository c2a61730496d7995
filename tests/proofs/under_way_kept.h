/*
 * What is kept with a plan and its progress: that segments can go on to be taken from it.
 */
#ifndef UNDER_WAY_KEPT_H
#define UNDER_WAY_KEPT_H

#include "kept.h"
#include "under_way.h"

/*@ lemma keeps_short{A, B}: \forall struct motion_plan *plan;
        keeps_plan{A, B}(plan) && 0 <= \at(plan->first, A) && \at(plan->order.sections, A) <= MOTION_SECTIONS &&
        is_short_ramped{A}(plan) ==> is_short_ramped{B}(plan);
    lemma keeps_known{A, B}: \forall struct motion_plan *plan;
        keeps_slope{A, B}(plan) && knows_slope{A}(\at(&plan->progress, A)) ==>
            knows_slope{B}(\at(&plan->progress, B));
    lemma keeps_laid_leg{A, B}: \forall struct motion_plan *plan;
        keeps_plan{A, B}(plan) && \at(plan->progress.profile, A) == \at(plan->progress.profile, B) &&
        0 <= \at(plan->first, A) <= \at(plan->progress.section, A) < MOTION_SECTIONS &&
        \at(plan->progress.section, A) == \at(plan->progress.section, B) && has_laid{A}(plan) ==> has_laid{B}(plan);
    lemma keeps_placed{A, B}: \forall struct motion_plan *plan;
        keeps_plan{A, B}(plan) && \at(plan->progress.profile, A) == \at(plan->progress.profile, B) &&
        \at(plan->progress.place, A) == \at(plan->progress.place, B) &&
        0 <= \at(plan->first, A) <= \at(plan->progress.section, A) < MOTION_SECTIONS &&
        \at(plan->progress.leg, A) == \at(plan->progress.leg, B) &&
        \at(plan->progress.section, A) == \at(plan->progress.section, B) && is_placed{A}(plan) ==> is_placed{B}(plan);
    lemma keeps_going{A, B}: \forall struct motion_plan *plan;
        keeps_plan{A, B}(plan) && keeps_profile{A, B}(plan) && keeps_place{A, B}(plan) &&
        0 <= \at(plan->first, A) && \at(plan->order.sections, A) <= MOTION_SECTIONS &&
        goes_on{A}(plan) ==> goes_on{B}(plan);
    lemma leg_of: \forall struct motion_plan *plan; has_laid(plan) && is_placed(plan) && 0 <= plan->progress.leg ==>
        has_leg(&plan->progress);
    lemma leg_order: \forall struct motion_leg *leg; is_leg_laid(*leg) ==> leg->from.step <= leg->to.step;
    lemma keeps_ready_plan{A, B}: \forall struct motion_plan *plan;
        keeps_plan{A, B}(plan) && 0 <= \at(plan->first, A) && is_ready{A}(plan) ==> is_ready{B}(plan);
    lemma rewound: \forall struct motion_plan *plan;
        is_ready(plan) && is_short_ramped(plan) && is_rewound(plan) ==> is_under_way(plan);
*/
/*@ lemma same_origin{A, B}: \forall struct motion_plan *plan; \at(plan->first, A) == \at(plan->first, B) &&
        is_same64{A, B}(\at(&plan->origin.time.ticks, A)) &&
        is_same32{A, B}(\at(&plan->origin.time.fraction, A)) &&
        is_same64{A, B}(\at(&plan->origin.step, A)) &&
        is_same64{A, B}(\at(&plan->origin.speed2, A)) &&
        is_same_flag{A, B}(\at(&plan->changed, A)) &&
        is_same_flag{A, B}(\at(&plan->stopping, A)) ==>
            keeps_origin{A, B}(plan);
    lemma same_profile{A, B}: \forall struct motion_plan *plan;
        is_same64{A, B}(\at(&plan->progress.profile.enter, A)) &&
        is_same64{A, B}(\at(&plan->progress.profile.turn, A)) &&
        is_same64{A, B}(\at(&plan->progress.profile.cruise, A)) &&
        is_same64{A, B}(\at(&plan->progress.profile.exit, A)) &&
        is_same64{A, B}(\at(&plan->progress.profile.begin, A)) &&
        is_same64{A, B}(\at(&plan->progress.profile.end, A)) &&
        is_same64{A, B}(\at(&plan->progress.profile.corner_a.step, A)) &&
        is_same64{A, B}(\at(&plan->progress.profile.corner_a.quanta, A)) &&
        is_same64{A, B}(\at(&plan->progress.profile.corner_b.step, A)) &&
        is_same64{A, B}(\at(&plan->progress.profile.corner_b.quanta, A)) &&
        is_same32{A, B}(\at(&plan->progress.profile.accel_steps_per_s2, A)) ==>
            keeps_profile{A, B}(plan);
    lemma same_place{A, B}: \forall struct motion_plan *plan;
        \at(plan->progress.leg, A) == \at(plan->progress.leg, B) &&
        \at(plan->progress.section, A) == \at(plan->progress.section, B) &&
        is_same64{A, B}(\at(&plan->progress.place.step, A)) &&
        is_same64{A, B}(\at(&plan->progress.place.quanta, A)) ==>
            keeps_place{A, B}(plan);
    lemma same_slope{A, B}: \forall struct motion_plan *plan;
        is_same64{A, B}(\at(&plan->progress.slope, A)) &&
        is_same64{A, B}(\at(&plan->progress.twice_speed2, A)) ==>
            keeps_slope{A, B}(plan);
    lemma same_order{A, B}: \forall struct motion_order *order;
        \at(order->sections, A) == \at(order->sections, B) &&
        is_same32{A, B}(\at(&order->start_speed_steps_per_s, A)) &&
        keeps_steps{A, B}(order) && keeps_accel{A, B}(order) && keeps_speeds{A, B}(order) ==>
            keeps_order{A, B}(order);
*/

#endif
