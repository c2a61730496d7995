/*
 * The frame of an axis: where it is and where measures end, from the steps of its motor.
 *
 * Three things lie between a motor and a measure. Backlash: the motor is `slack` steps ahead of the axis, 0 to
 * `backlash`; a pulse forward raises the slack, when that is full the position, one backward lowers the slack, when
 * that is 0 the position. Carried remainders: the axis last reached base_um micrometres from base_step, and the next
 * measure begins there, not at the step that was nearest. Absolute positions: zero_step has the position zero_um.
 * Pure arithmetic on the caller's struct; main only.
 */
#ifndef POS_FRAME_H
#define POS_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "../measure/pos_measure.h"

struct pos_frame {
    struct pos_scale scale;
    int64_t step;        /* where the axis is */
    int64_t motor_steps; /* the motor's step when the axis is at step 0 without slack */
    int64_t base_step;   /* B */
    int64_t base_um;     /* M */
    int64_t zero_step;   /* C */
    int64_t zero_um;     /* X */
    uint32_t backlash;   /* steps */
    bool referenced;
};

/* Where a measure ends. */
struct pos_target {
    int64_t step;
    int64_t base_step; /* B and M, when it has been reached */
    int64_t base_um;
    bool cut; /* by a software limit: the step is the last one inside */
};

/* A way of pulses. */
struct pos_way {
    uint64_t pulses;
    bool backward;
};

/* At step 0, where the motor's count is 0, too. */
void pos_frame_init(struct pos_frame *frame, const struct pos_scale *scale, uint32_t backlash_um);

/* Another scale or backlash, or the same once more. Where the backlash is another one in steps, all slack is taken up.
 * B and C are where the axis is, M and X 0; it is not referenced. */
void pos_frame_reset(struct pos_frame *frame, const struct pos_scale *scale, uint32_t backlash_um, int64_t motor_steps);

/* The step of the axis when the motor is at one that it has come to since pos_frame_follow, one way only. */
int64_t pos_frame_step_of(const struct pos_frame *frame, int64_t motor_steps);

/* The motor has come to a step; it has gone one way only since the last time. */
void pos_frame_follow(struct pos_frame *frame, int64_t motor_steps);

/* The absolute position of a step, micrometres. */
int64_t pos_frame_position_um(const struct pos_frame *frame, int64_t step);

/* Whether M stays in its bounds with a way, micrometres. */
bool pos_frame_may_aim(const struct pos_frame *frame, int32_t way_um);

/* The target of a way that may be aimed, or of a position, micrometres. */
void pos_frame_aim(const struct pos_frame *frame, int32_t way_um, struct pos_target *target);
void pos_frame_aim_at(const struct pos_frame *frame, int32_t position_um, struct pos_target *target);

/* Cuts a target at the last step inside of the limits, micrometres, that lies on the way. Who is outside may go
 * inwards. */
void pos_frame_limit(const struct pos_frame *frame, struct pos_target *target, int64_t min_um, int64_t max_um);

/* The pulses from the motor's step to a target of the axis. */
struct pos_way pos_frame_way(const struct pos_frame *frame, int64_t motor_steps, int64_t step);

/* Micrometres from where the axis is to the end of a target, as the next measures count them. */
int64_t pos_frame_left_um(const struct pos_frame *frame, const struct pos_target *target);

/* A target has been reached. */
void pos_frame_reach(struct pos_frame *frame, const struct pos_target *target);

/* A measure has been given up: where the axis stands on another step than the last one that it reached, what comes
 * begins here. */
void pos_frame_give_up(struct pos_frame *frame);

/* A step has a position: the axis is referenced, and what comes begins there. */
void pos_frame_refer(struct pos_frame *frame, int64_t step, int64_t position_um);

#endif
