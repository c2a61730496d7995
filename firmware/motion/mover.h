/*
 * The mover: one motor's moves, from order to pulses, with all that can end a move early.
 *
 * Comes in: orders, stops and changes of speed from the interpreter; the inputs, sensed in the unit's tick. Goes out:
 * segments to the motor's step channel. Everything here is called from main, except what ends with _isr. Plans belong
 * to main and the plan interrupt, which main holds off by itself where it must (hal_run.h). The tick interrupt only
 * brakes: it may come while a plan is being made, so it reads nothing of a plan but the order.
 */
#ifndef MOVER_H
#define MOVER_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "base_limits.h"
#include "hal_trace.h"
#include "motion_order.h"
#include "motion_plan.h"
#include "step_channel.h"

/* What inputs do to the move in progress; bit 0 is input 1. */
struct mover_guards {
    uint8_t stop_high;  /* an input that is 1 stops down the ramp (M) */
    uint8_t stop_low;   /* an input that is 0 stops down the ramp (N) */
    uint8_t stop_total; /* an input that is 1 stops down the ramp; told apart by its cause (X) */
    uint8_t halt_high;  /* an input that is 1 ends the move at once: a limit run */
};

struct mover {
    struct step_channel channel;
    struct motion_plan plan;
    struct mover_guards guards;
    struct step_cursor brake; /* while `braking`: the pulse from which the motor brakes and the stop is to be planned */
    _Atomic unsigned cause;   /* enum hal_trace_stop: why the move is being stopped or was stopped; NONE: not at all */
    _Atomic uint8_t inputs;   /* as sensed last */
    _Atomic bool moving;
    _Atomic bool stopping; /* the stop is to be planned */
    bool braking;
    bool connected; /* STEP and DIR reach their pins */
    uint8_t motor;
    int64_t real_steps; /* while not connected: the position at which the motor has stayed */
};

/* Stands at position 0, connected. */
void mover_init(struct mover *mover, unsigned motor);

/* Begins a move at `start_tick`, the unit's time, which may be up to 200 us past: the first pulse comes a whole step
 * later. Where an input of a guard has the guarded level already, no step is made and the cause is set. */
void mover_start(struct mover *mover, const struct motion_order *order, bool backward, uint64_t start_tick,
                 const struct mover_guards *guards);

/* Stops the move down its ramp, from the next pulse that is due; nothing if it is being stopped already. */
void mover_stop(struct mover *mover, enum hal_trace_stop cause);

/* Changes the speed of the present section, from the next pulse that is due; nothing while the move is being stopped
 * and in a limit run. */
void mover_change_speed(struct mover *mover, uint32_t speed_steps_per_s);

/* Sees the end of a move; in main, whenever the step interrupt asks for it. */
void mover_poll(struct mover *mover);

/* Lays the next segment, if one is left and there is room; in main, after all motors have been polled, and in turns
 * with the other motors. False if there is nothing to do. */
bool mover_feed(struct mover *mover);

/* Whether a move is in progress: from mover_start until mover_poll has seen its last pulse. */
bool mover_is_moving(const struct mover *mover);

/* Why the last move ended before its end; NONE if it did not. */
enum hal_trace_stop mover_stop_cause(const struct mover *mover);

/* The unit's time of the last pulse of the move that has ended, or of its start if there was no pulse; to be asked
 * within 25 s of it. */
uint64_t mover_end_tick(const struct mover *mover);

/* Steps made in the present or last move. */
uint64_t mover_steps_made(const struct mover *mover);

/* The absolute position; set only while standing. */
int64_t mover_position_steps(const struct mover *mover);
void mover_set_position(struct mover *mover, int64_t position_steps);

/* Disconnects STEP and DIR from their pins, or connects them again; only while standing. What is made while they are
 * disconnected the motor does not make, so its position then goes back to what it was when they were. */
void mover_connect(struct mover *mover, bool connected);

/* Whether the last section of a move of several has begun since the last call. */
bool mover_take_mark(struct mover *mover);

/* The break points of the move in progress (motion_plan.h); 0 while standing. */
unsigned mover_corners(const struct mover *mover, struct motion_corner corners[MOTION_CORNERS_MAX]);

/* Tick interrupt, or main before it starts: ends the move if an input says so, or begins to brake, at the first pulse
 * that has come or will come after `since`, the unit's time before which the inputs have not changed. True: the plan
 * interrupt is needed. */
bool mover_sense_isr(struct mover *mover, uint8_t inputs, uint64_t since);

/* Plan interrupt: plans the stop of a motor that has begun to brake. */
void mover_plan_isr(struct mover *mover);

/* Step interrupt: the armed pulse has been made. True: main has something to do. */
bool mover_pulse_isr(struct mover *mover);

#endif
