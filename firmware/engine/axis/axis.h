/*
 * The axis: the engine's door for one motor. It makes one motion at a time, from order to pulses, and owns how the
 * motion ends.
 *
 * Comes in: orders, stops and changes of speed from a unit; the inputs, sensed in the unit's tick. Goes out: segments
 * to the motor's step channel, and the events MOVE, STOP, SPEED and DONE to the trace. A motion begins with axis_begin
 * or axis_go_on, and is over when axis_take_end has said so; axis_state.h has the states between, axis_cause.h what
 * can end it early.
 */
#ifndef AXIS_H
#define AXIS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "../motion/motion_corners.h"
#include "../motion/motion_order.h"
#include "../motion/motion_plan.h"
#include "../step/step_channel.h"
#include "axis_cause.h"
#include "axis_state.h"

/* What inputs do to the motion; bit 0 is input 1. */
struct axis_guards {
    uint8_t stop_high;  /* an input that is 1 stops down the ramp */
    uint8_t stop_low;   /* an input that is 0 stops down the ramp */
    uint8_t abort_high; /* an input that is 1 stops down the ramp, and more than this motion is over */
    uint8_t halt_high;  /* an input that is 1 ends the motion at once: a limit run */
};

/*
 * One motor, about 1.8 kB. Who may call:
 *   step interrupt   axis_lay_isr
 *   tick interrupt   axis_sense_isr, also main before the interrupts start
 *   plan interrupt   axis_plan_isr
 *   main             everything else
 * Plans belong to main and the plan interrupt, which main holds off by itself where it must (hal_run.h). The tick
 * interrupt only brakes: it may come while a plan is being made, so it reads nothing of a plan but the order.
 */
struct axis {
    struct step_channel channel;
    struct motion_plan plan;
    struct motion_order order; /* of the motion, as it began; when its end has been taken, what is left of it */
    struct axis_guards guards;
    struct step_cursor brake_from; /* while BRAKING, if the channel brakes: the pulse from which the stop is planned */
    _Atomic unsigned state;        /* enum axis_state */
    _Atomic unsigned cause;        /* enum axis_cause, of the present or last motion; set once, by what stops it */
    _Atomic uint8_t inputs;        /* as sensed last */
    bool marked;                   /* the only section has begun, and main has not asked yet */
    bool simulated;                /* STEP and DIR do not reach their pins */
    uint8_t motor;
    int64_t real_steps; /* while simulated: the position at which the motor has stayed */
};

/* Stands at position 0, not simulated. */
void axis_init(struct axis *axis, unsigned motor);

/* Begins a motion at `start_tick`, the unit's time, which may be up to 200 us past: the first pulse comes a whole step
 * later. Where an input of a guard has the guarded level already, no step is made and the cause is set. Only while
 * STANDING. */
void axis_begin(struct axis *axis, const struct motion_order *order, bool backward, uint64_t start_tick,
                const struct axis_guards *guards);

/* Begins what an early end has left of the last motion, with the same direction and guards. Only while STANDING, and
 * if axis_has_rest. */
void axis_go_on(struct axis *axis, uint64_t start_tick);

/* Whether something is left of the motion that has been taken last. A run without end is always left. */
bool axis_has_rest(const struct axis *axis);

/* What an early end leaves of the present or last motion is not gone on with. */
void axis_forget(struct axis *axis);

/* Whether the present or last motion is a run without end, and not one to a limit. */
bool axis_is_jog(const struct axis *axis);

/* Stops the motion down its ramp, from the next pulse that is due. True if this is why it ends; else nothing
 * happens, as it does not move, or is being stopped already. AXIS_CAUSE_PAUSE is such a cause: axis_go_on is the way
 * back. */
bool axis_stop(struct axis *axis, enum axis_cause cause);

/* Changes the speed of the present section, from the next pulse that is due; nothing while the motion is being stopped,
 * and in a limit run. */
void axis_change_speed(struct axis *axis, uint32_t speed_steps_per_s);

/* Sees the end of a motion; whenever the step interrupt asks for it. */
void axis_poll(struct axis *axis);

/* Plans the next segment, if one is left and there is room; after all axes have been polled, and in turns with them.
 * False if there is nothing to do. */
bool axis_feed(struct axis *axis);

/* The motion is over: STANDING from now on. False if it has not ended, or has been taken. */
bool axis_take_end(struct axis *axis);

/* Whether a motion has begun whose end has not been taken. This and the next are inline, as main asks in every pass. */
static inline bool axis_is_busy(const struct axis *axis)
{
    return (enum axis_state)atomic_load_explicit(&axis->state, memory_order_relaxed) != AXIS_STANDING;
}

/* Whether pulses are still to come: from axis_begin until axis_poll has seen the last one. */
static inline bool axis_is_moving(const struct axis *axis)
{
    enum axis_state state = (enum axis_state)atomic_load_explicit(&axis->state, memory_order_relaxed);
    return state > AXIS_STANDING && state < AXIS_ENDED;
}

/* Why the present or last motion ends before its end. */
enum axis_cause axis_cause(const struct axis *axis);

/* The unit's time of the last pulse of the motion that has ended, or of its start if there was no pulse; to be asked
 * within 25 s of it. */
uint64_t axis_end_tick(const struct axis *axis);

/* Steps made in the present or last motion. */
uint64_t axis_steps_made(const struct axis *axis);

/* The absolute position; set only while no pulse is to come. */
int64_t axis_position_steps(const struct axis *axis);
void axis_set_position(struct axis *axis, int64_t position_steps);

/* Simulation: STEP and DIR are disconnected from their pins, or connected again; nothing happens while pulses are to
 * come. What is made in simulation the motor does not make, so its position then goes back to what it was. */
void axis_simulate(struct axis *axis, bool simulated);
bool axis_is_simulated(const struct axis *axis);

/* Whether the last section of the motion has begun since the last call. */
bool axis_take_mark(struct axis *axis);

/* The break points of the motion in progress (motion_corners.h); 0 while no pulse is to come. */
unsigned axis_corners(const struct axis *axis, struct motion_corner corners[MOTION_CORNERS_MAX]);

/* Ends the motion if an input says so, or begins to brake, at the first pulse that has come or will come after `since`,
 * the unit's time before which the inputs have not changed. True: the plan interrupt is needed. */
bool axis_sense_isr(struct axis *axis, uint8_t inputs, uint64_t since);

/* Plans the stop of a motor that has begun to brake. */
void axis_plan_isr(struct axis *axis);

/* Lays the pulses that are due next: what lay_isr of hal_run.h is for one motor. */
static inline unsigned axis_lay_isr(struct axis *axis, struct hal_step_room *room)
{
    return step_channel_lay_isr(&axis->channel, room);
}

#endif
