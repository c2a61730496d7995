/*
 * The plan of one move: an order on one side, segments on the other.
 *
 * A plan begins at a whole step with a known time and a known square of the speed: the start of the move, or the pulse
 * at which a stop or a change of speed takes effect. The squares of all speeds at whole steps are whole numbers
 * (v^2 = v0^2 + 2*A*k), so nothing is lost when a plan is cut and laid anew. Look-ahead sets the speeds at the section
 * borders; each section is then at most three legs (ramp, cruise, ramp), each leg one segment in closed form.
 * Pure arithmetic on the caller's struct; main or tick interrupt, never both at once. About 600 bytes.
 */
#ifndef MOTION_PLAN_H
#define MOTION_PLAN_H

#include <stdbool.h>
#include <stdint.h>

#include "motion_order.h"
#include "motion_point.h"
#include "motion_profile.h"
#include "step_segment.h"

/* A break point of the ideal speed curve: nearest step, nearest step/s. */
struct motion_corner {
    uint64_t step;
    uint32_t speed_steps_per_s;
};

/* The start, the cut, three a section. */
enum {
    MOTION_CORNERS_MAX = 2 + 3 * MOTION_SECTIONS
};

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

struct motion_plan {
    struct motion_order order;
    struct motion_point origin;            /* where the plan begins */
    uint64_t exit_speed2[MOTION_SECTIONS]; /* square of the speed at the end of each section, (steps/s)^2 */
    struct motion_progress progress;
    uint64_t begin_speed2; /* with which the move started */
    uint64_t mark_step;    /* where the order's last section of several begins; 0 for one */
    uint8_t first;         /* the section that the origin is in */
    bool changed;          /* the speed of the first section was changed: it may jump below S */
    bool stopping;         /* brakes down to S and ends there */
};

/* What may be done before a stop has been planned. */
struct motion_brake {
    int32_t accel;  /* quanta a tick^2 (step_scale.h) */
    uint64_t until; /* the last step at which that is right for certain: half of the way down to S, in one section */
};

/* Plans a move from its start. */
void motion_plan_begin(struct motion_plan *plan, const struct motion_order *order, uint64_t start_tick);

/* The next segment; false if there is none left. */
bool motion_plan_next(struct motion_plan *plan, struct step_segment *segment);

/* How to brake from the step `step` on, where the motor has `slope`. False if the move is being stopped or ends
 * there. */
bool motion_plan_brake(const struct motion_plan *plan, uint64_t step, uint64_t slope, struct motion_brake *brake);

/* Lays the plan anew from the point `at`, stopping down the ramp with the acceleration of each section that it comes
 * through. False, and nothing is changed, if the move is being stopped or ends there. */
bool motion_plan_stop(struct motion_plan *plan, const struct motion_point *at);

/* Lays the plan anew from the point `at` with a new speed for the section that begins or goes on there. False, and
 * nothing is changed, if the move is being stopped or ends there. */
bool motion_plan_change_speed(struct motion_plan *plan, const struct motion_point *at, uint32_t speed_steps_per_s);

/* The break points of the ideal curve: the start of the move (step 1, start speed), the origin if it is a cut, every
 * corner after it, and the end with speed 0 unless the run is endless. Returns their number. */
unsigned motion_plan_corners(const struct motion_plan *plan, struct motion_corner corners[MOTION_CORNERS_MAX]);

#endif
