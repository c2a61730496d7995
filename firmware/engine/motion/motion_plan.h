/*
 * The plan of one move: an order comes in, segments go out.
 *
 * A plan begins at a whole step with a known time and a known square of the speed: the start of the
 * move, or the pulse at which a stop or a change of speed takes effect. The squares of all speeds
 * at whole steps are whole numbers (v^2 = v0^2 + 2*A*k), so nothing is lost where one plan replaces
 * another. Look-ahead sets the speeds at the section borders (motion_lookahead.c); each section is
 * then at most three legs (ramp, cruise, ramp), each leg one segment in closed form
 * (motion_legs.c). Stops and changes of speed: motion_replan.c.
 *
 * Pure arithmetic on the caller's struct of about 600 bytes, which one context at a time may use:
 * main or the plan interrupt. Only motion_plan_brake may interrupt the others, as it reads no more
 * than the order's steps, accelerations and S, which a change of speed leaves alone.
 */
#ifndef MOTION_PLAN_H
#define MOTION_PLAN_H

#include <stdbool.h>
#include <stdint.h>

#include "motion_order.h"
#include "motion_point.h"
#include "motion_profile.h"
#include "../step/step_segment.h"

/* What the plan hands over next. */
struct motion_progress {
    struct motion_profile profile; /* of `section`, from its first leg on */
    struct motion_time time;
    struct motion_place place;
    uint64_t twice_speed2; /* of which `slope` is the slope: each root is wanted at two legs */
    uint64_t slope;
    uint8_t section;
    uint8_t leg; /* 0 to 2 */
};

enum motion_plan_kind {
    MOTION_PLAN_ORDERED,
    MOTION_PLAN_CHANGED, /* the speed of the section of the origin was changed: it may jump below S there */
    MOTION_PLAN_STOP     /* brakes down to S and ends there */
};

struct motion_plan {
    struct motion_order order;
    struct motion_point origin;            /* where the plan begins */
    uint64_t exit_speed2[MOTION_SECTIONS]; /* square of the speed at the end of each section, (steps/s)^2 */
    struct motion_progress progress;
    uint64_t begin_speed2; /* with which the move started */
    uint64_t mark_step;    /* where the order's last section of several begins; 0 for one */
    uint8_t first;         /* the section that the origin is in */
    enum motion_plan_kind kind;
};

/* What may be done before a stop has been planned. */
struct motion_brake {
    int32_t accel;  /* quanta a tick^2 (step_scale.h) */
    uint64_t until; /* the last step at which that is right for certain: halfway down to S, in one section */
};

/* Plans a move from its start. */
void motion_plan_begin(struct motion_plan *plan, const struct motion_order *order, uint64_t start_tick);

/* The next segment; false if there is none left. */
bool motion_plan_next(struct motion_plan *plan, struct step_segment *segment);

/* How to brake from the step `step` on, where the motor has `slope`. False if the move ends there.
 * Not to be asked of a stop. */
bool motion_plan_brake(const struct motion_plan *plan, uint64_t step, uint64_t slope, struct motion_brake *brake);

/* Replaces the plan from the point `at` on by a stop down the ramp, with the acceleration of each
 * section that it comes through. False, and nothing is changed, if the move ends there. Not to be
 * asked of a stop. */
bool motion_plan_stop(struct motion_plan *plan, const struct motion_point *at);

/* Replaces the plan from the point `at` on by one with a new speed for the section that begins
 * or goes on there. False, and nothing is changed, if the move ends there. Not to be asked of a
 * stop. */
bool motion_plan_change_speed(struct motion_plan *plan, const struct motion_point *at, uint32_t speed_steps_per_s);

#endif
