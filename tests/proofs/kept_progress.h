/*
 * What a plan and its progress keep between two places of the code.
 */
#ifndef KEPT_PROGRESS_H
#define KEPT_PROGRESS_H

#include "plans.h"

/*@ predicate is_same64{A, B}(uint64_t *cell) = \at(*cell, A) == \at(*cell, B);
    predicate is_same32{A, B}(uint32_t *cell) = \at(*cell, A) == \at(*cell, B);
    predicate is_same_kind{A, B}(enum motion_plan_kind *cell) = \at(*cell, A) == \at(*cell, B);
*/

/* The cells of an origin, a profile, a place and a slope: SAME(type, cell) for each. The provers can say that a cell is
 * kept where something else is written, and cannot say it of the whole. */
#define ORIGIN_CELLS(SAME, plan) \
    SAME(64, &plan->origin.time.ticks) SAME(32, &plan->origin.time.fraction) SAME(64, &plan->origin.step) \
    SAME(64, &plan->origin.speed2) SAME(_kind, &plan->kind)
#define PROFILE_CELLS(SAME, plan) \
    SAME(64, &plan->progress.profile.enter) SAME(64, &plan->progress.profile.turn) \
    SAME(64, &plan->progress.profile.cruise) SAME(64, &plan->progress.profile.exit) \
    SAME(64, &plan->progress.profile.begin) SAME(64, &plan->progress.profile.end) \
    SAME(64, &plan->progress.profile.corner_a.step) SAME(64, &plan->progress.profile.corner_a.quanta) \
    SAME(64, &plan->progress.profile.corner_b.step) SAME(64, &plan->progress.profile.corner_b.quanta) \
    SAME(32, &plan->progress.profile.accel_steps_per_s2)
#define PLACE_CELLS(SAME, plan) SAME(64, &plan->progress.place.step) SAME(64, &plan->progress.place.quanta)
#define SLOPE_CELLS(SAME, plan) SAME(64, &plan->progress.slope) SAME(64, &plan->progress.twice_speed2)

#define ENSURES_SAME(type, cell) ensures is_same##type{Old, Post}(cell);
#define ENSURES_PLAN_KEPT(plan) \
    ensures keeps_steps{Old, Post}(&plan->order); \
    ensures keeps_accel{Old, Post}(&plan->order); \
    ensures keeps_speeds{Old, Post}(&plan->order); \
    ensures keeps_exits{Old, Post}(plan); \
    ENSURES_SAME(32, &plan->order.start_speed_steps_per_s) \
    ORIGIN_CELLS(ENSURES_SAME, plan) PROFILE_CELLS(ENSURES_SAME, plan) PLACE_CELLS(ENSURES_SAME, plan) \
    ensures time: plan->progress.time.ticks == \old(plan->progress.time.ticks);

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
