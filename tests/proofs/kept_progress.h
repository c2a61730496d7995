/*
 * What a plan and its progress keep between two places of the code.
 */
#ifndef KEPT_PROGRESS_H
#define KEPT_PROGRESS_H

#include "plans.h"

/*@ predicate is_same64{A, B}(uint64_t *cell) = \at(*cell, A) == \at(*cell, B);
    predicate is_same32{A, B}(uint32_t *cell) = \at(*cell, A) == \at(*cell, B);
    predicate is_same_flag{A, B}(bool *cell) = \at(*cell, A) == \at(*cell, B);
*/

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
    predicate keeps_place{A, B}(struct motion_plan *plan) =
        \at(plan->progress.place.step, A) == \at(plan->progress.place.step, B) &&
        \at(plan->progress.place.quanta, A) == \at(plan->progress.place.quanta, B) &&
        \at(plan->progress.leg, A) == \at(plan->progress.leg, B) &&
        \at(plan->progress.section, A) == \at(plan->progress.section, B);
    predicate keeps_plan{A, B}(struct motion_plan *plan) =
        keeps_order{A, B}(\at(&plan->order, A)) && keeps_origin{A, B}(plan) && keeps_exits{A, B}(plan);
    predicate keeps_slope{A, B}(struct motion_plan *plan) =
        \at(plan->progress.slope, A) == \at(plan->progress.slope, B) &&
        \at(plan->progress.twice_speed2, A) == \at(plan->progress.twice_speed2, B);
*/

#endif
