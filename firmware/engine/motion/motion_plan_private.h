/*
 * What the parts of a plan share, for them alone: motion_plan.c begins one, motion_lookahead.c sets
 * the speeds at the borders of the sections, motion_legs.c hands over segments, motion_replan.c
 * stops and changes, motion_corners.c tells the break points.
 */
#ifndef MOTION_PLAN_PRIVATE_H
#define MOTION_PLAN_PRIVATE_H

#include "motion_plan.h"

/* The step at which a section begins. */
uint64_t motion_plan_section_begin(const struct motion_plan *plan, unsigned section);

/* The span of a section, as far as it comes after the origin. */
struct motion_span motion_plan_section_span(const struct motion_plan *plan, unsigned section, uint64_t enter_speed2);

/* Puts the progress at the origin. */
void motion_plan_rewind(struct motion_plan *plan);

/* The highest square of a speed at the beginning of a section from which its end can be braked
 * to. */
uint64_t motion_lookahead_brakeable(const struct motion_plan *plan, unsigned section);

/* Sets the speeds at the borders from the last one back: from no border may the next one be out of
 * reach of the brake. */
void motion_lookahead_backward(struct motion_plan *plan);

/* Then lowers them from the origin on: to no border faster than the ramp can get. */
void motion_lookahead_forward(struct motion_plan *plan);

/* The profile of a section, or of a stop's part in it. */
struct motion_profile motion_legs_fit_section(const struct motion_plan *plan, unsigned section);

#endif
