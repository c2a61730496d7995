#include "interpreter_private.h"

#include "hal_board.h"
#include "hal_trace.h"

/* The last section has begun: each output only once, also if K and C75 come in between, and only if its function is
 * still on. */
static void set_mark_outputs(struct interpreter *interpreter, uint64_t now_ticks)
{
    unsigned outputs = interpreter->order.outputs_left & interpreter->order.mark_outputs;
    for (unsigned i = 0; i < UNIT_OUTPUTS; i++) {
        if ((outputs >> i & 1U) != 0) {
            interpreter_shared_set(interpreter->shared, i + 1U, true, interpreter->motor + 1U, now_ticks);
        }
    }
    interpreter->order.outputs_left = 0;
}

/* A motor may move, and the clock is one at which it can begin. */
static bool ready_move(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (!hal_board_may_move()) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_NO_CRYSTAL, now_ticks);
        return false;
    }
    interpreter_align_clock(interpreter, now_ticks);
    interpreter->state = INTERPRETER_MOVING;
    return true;
}

static void watch_mark(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (axis_take_mark(interpreter->axis)) {
        set_mark_outputs(interpreter, now_ticks);
    }
}

void interpreter_begin_move(struct interpreter *interpreter, const struct motion_order *order, bool backward,
                            uint8_t halt_high, uint8_t outputs, uint64_t now_ticks)
{
    struct axis_guards guards = interpreter->guards;
    guards.halt_high = halt_high;
    if (ready_move(interpreter, now_ticks)) {
        interpreter->order.outputs_left = outputs;
        axis_begin(interpreter->axis, order, backward, interpreter->clock, &guards);
        watch_mark(interpreter, now_ticks);
    }
}

/* A guard that has stopped a move is spent; not one that came when all of its steps were made or could not be helped
 * any more: its input is in the way of the next move. */
static void spend_guards(struct interpreter *interpreter, enum axis_cause cause)
{
    bool stopped = axis_has_rest(interpreter->axis);
    if (stopped && (cause == AXIS_CAUSE_HIGH)) {
        interpreter->guards.stop_high = 0;
    } else if (stopped && (cause == AXIS_CAUSE_LOW)) {
        interpreter->guards.stop_low = 0;
    }
}

/* K has come: what is left of its move is gone on with after C75. A move that something else had begun to stop before
 * is over. */
static void settle_resume(struct interpreter *interpreter, enum axis_cause cause)
{
    if (cause != AXIS_CAUSE_PAUSE || !axis_has_rest(interpreter->axis)) {
        interpreter->resume_state = INTERPRETER_RUNNING;
    }
}

/* Whether an X that has ended the move ends the program, too: not what was stored after `\`. */
static bool is_ended_by_abort(const struct interpreter *interpreter)
{
    bool reset = interpreter->resume_state == INTERPRETER_RESETTING;
    return interpreter->state == INTERPRETER_MOVING || (interpreter_is(interpreter, INTERPRETER_PAUSED) && !reset);
}

/* What the end of a move means in the state that the program is in by now. */
static void leave_move(struct interpreter *interpreter, enum axis_cause cause, uint64_t now_ticks)
{
    if (cause == AXIS_CAUSE_ABORT && is_ended_by_abort(interpreter)) {
        interpreter->state = INTERPRETER_ENDED;
    } else if (interpreter->state == INTERPRETER_MOVING) {
        interpreter->state = INTERPRETER_RUNNING;
    } else if (interpreter->state == INTERPRETER_STOPPED) {
        settle_resume(interpreter, cause);
    } else if (interpreter->state == INTERPRETER_RESUMING) {
        settle_resume(interpreter, cause);
        interpreter_continue(interpreter, now_ticks);
    } else if (interpreter->state == INTERPRETER_RESETTING) {
        interpreter->state = INTERPRETER_IDLE;
    }
    if (interpreter->state == INTERPRETER_ENDED) {
        interpreter_trace(interpreter, interpreter->clock, HAL_TRACE_END, 0);
    }
}

static void end_move(struct interpreter *interpreter, uint64_t now_ticks)
{
    enum axis_cause cause = axis_cause(interpreter->axis);
    interpreter_raise_clock(interpreter, axis_end_tick(interpreter->axis));
    spend_guards(interpreter, cause);
    leave_move(interpreter, cause, now_ticks);
}

/* T41 and C41, whoever has switched them, get to a motor here: where it stands, and before its next move. */
void interpreter_watch_move(struct interpreter *interpreter, uint64_t now_ticks)
{
    struct axis *axis = interpreter->axis;
    bool ended = false;
    if (axis_is_busy(axis)) {
        axis_poll(axis);
        watch_mark(interpreter, now_ticks);
        if (axis_is_moving(axis)) {
            return;
        }
        ended = axis_take_end(axis);
    }
    axis_simulate(axis, interpreter_shared_is_simulating(interpreter->shared));
    if (ended) {
        end_move(interpreter, now_ticks);
    }
}

void interpreter_stop(struct interpreter *interpreter, enum axis_cause cause, uint64_t now_ticks)
{
    const struct axis *axis = interpreter->axis;
    bool told = axis_stop(interpreter->axis, cause) || (axis_is_busy(axis) && axis_cause(axis) == cause);
    if (!told) {
        interpreter_trace(interpreter, now_ticks, HAL_TRACE_STOP, cause);
    }
}

static void continue_move(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (ready_move(interpreter, now_ticks)) {
        axis_go_on(interpreter->axis, interpreter->clock);
        watch_mark(interpreter, now_ticks);
    }
}

void interpreter_continue(struct interpreter *interpreter, uint64_t now_ticks)
{
    interpreter->state = interpreter->resume_state;
    interpreter_raise_clock(interpreter, now_ticks);
    if (interpreter->state == INTERPRETER_WAIT_TIME) {
        interpreter->clock = now_ticks + interpreter->wait.left_ticks;
    } else if (interpreter->state == INTERPRETER_MOVING) {
        continue_move(interpreter, now_ticks);
    }
}
