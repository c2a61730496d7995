#include "interpreter_private.h"

#include "hal_board.h"
#include "hal_trace.h"

void interpreter_order_section(struct interpreter *interpreter, uint64_t steps, uint32_t speed_steps_per_s)
{
    interpreter->order.sections = 1;
    interpreter->order.start_speed_steps_per_s = interpreter->start_speed;
    interpreter->order.section[0] = (struct motion_section){
        .steps = steps,
        .speed_steps_per_s = speed_steps_per_s,
        .accel_steps_per_s2 = interpreter->acceleration,
    };
}

static bool order_is_endless(const struct motion_order *order)
{
    return order->section[0].steps == MOTION_ENDLESS_STEPS;
}

bool interpreter_order_is_jog(const struct interpreter *interpreter)
{
    return order_is_endless(&interpreter->order) && interpreter->order_guards.halt_high == 0;
}

static int64_t order_steps(const struct motion_order *order)
{
    uint64_t steps = 0;
    for (unsigned i = 0; i < order->sections; i++) {
        steps += order->section[i].steps;
    }
    return (int64_t)steps;
}

static int64_t signed_steps(const struct interpreter *interpreter, int64_t steps)
{
    return interpreter->order_backward ? -steps : steps;
}

/* The last section has begun: each output only once, also if K and C75 come in between, and only if its function is
 * still on. */
static void set_order_outputs(struct interpreter *interpreter, uint64_t now_ticks)
{
    unsigned outputs = interpreter->order_outputs & interpreter->mark_outputs;
    for (unsigned i = 0; i < UNIT_OUTPUTS; i++) {
        if ((outputs >> i & 1U) != 0) {
            io_set(interpreter->io, i + 1U, true, interpreter->motor + 1U, now_ticks);
        }
    }
    interpreter->order_outputs = 0;
}

/* Begins `order` with its guards, outputs and direction as they are. */
static void start_order(struct interpreter *interpreter, uint64_t now_ticks)
{
    struct mover *mover = interpreter->mover;
    int64_t steps = order_is_endless(&interpreter->order) ? 0 : order_steps(&interpreter->order);

    if (!hal_board_may_move()) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_NO_CRYSTAL, now_ticks);
        return;
    }
    interpreter_align_clock(interpreter, now_ticks);
    interpreter->state = INTERPRETER_MOVING;
    interpreter->under_way = true;
    interpreter_trace(interpreter, interpreter->clock, HAL_TRACE_MOVE, signed_steps(interpreter, steps));
    mover_start(mover, &interpreter->order, interpreter->order_backward, interpreter->clock,
                &interpreter->order_guards);
    if (interpreter->order.sections == 1 && mover_stop_cause(mover) == HAL_TRACE_STOP_NONE) {
        set_order_outputs(interpreter, now_ticks);
    }
}

void interpreter_begin_move(struct interpreter *interpreter, bool backward, uint8_t halt_high, uint8_t outputs,
                            uint64_t now_ticks)
{
    interpreter->order_backward = backward;
    interpreter->order_outputs = outputs;
    interpreter->order_guards = (struct mover_guards){
        .stop_high = interpreter->guard_high,
        .stop_low = interpreter->guard_low,
        .stop_total = interpreter->total_stop,
        .halt_high = halt_high,
    };
    start_order(interpreter, now_ticks);
}

/* Takes the steps that were made off the order; no section is left if that was all. A run without end stays one. */
static void cut_order(struct motion_order *order, uint64_t steps_made)
{
    unsigned done = 0;
    if (order_is_endless(order)) {
        return;
    }
    while (done < order->sections && steps_made >= order->section[done].steps) {
        steps_made -= order->section[done].steps;
        done++;
    }
    order->sections = (uint8_t)(order->sections - done);
    for (unsigned i = 0; i < order->sections; i++) {
        order->section[i] = order->section[i + done];
    }
    if (order->sections > 0) {
        order->section[0].steps -= steps_made;
    }
}

/* The motor stands after K. A move that something else had begun to stop before is over. */
static void keep_rest(struct interpreter *interpreter, enum hal_trace_stop cause, uint64_t now_ticks)
{
    if (cause == HAL_TRACE_STOP_COMMAND) {
        cut_order(&interpreter->order, mover_steps_made(interpreter->mover));
    } else {
        interpreter->order.sections = 0;
    }
    if (interpreter->order.sections == 0) {
        interpreter->resume_state = INTERPRETER_RUNNING;
    }
    if (interpreter->resuming) {
        interpreter_continue(interpreter, now_ticks);
    }
}

/* A guard that has stopped a move is spent. */
static void spend_guards(struct interpreter *interpreter, enum hal_trace_stop cause)
{
    if (cause == HAL_TRACE_STOP_HIGH) {
        interpreter->guard_high = 0;
    } else if (cause == HAL_TRACE_STOP_LOW) {
        interpreter->guard_low = 0;
    }
}

/* What the end of a move means in the state that the motor is in by now. */
static void leave_move(struct interpreter *interpreter, enum hal_trace_stop cause, uint64_t now_ticks)
{
    uint8_t go_on = cause == HAL_TRACE_STOP_TOTAL ? INTERPRETER_ENDED : INTERPRETER_RUNNING;
    if (interpreter->state == INTERPRETER_MOVING) {
        interpreter->state = go_on;
    } else if (interpreter->state == INTERPRETER_STOPPED && cause == HAL_TRACE_STOP_TOTAL &&
               interpreter->resume_state != INTERPRETER_RESETTING) {
        interpreter->state = INTERPRETER_ENDED;
    } else if (interpreter->state == INTERPRETER_STOPPED) {
        keep_rest(interpreter, cause, now_ticks);
    } else if (interpreter->state == INTERPRETER_RESETTING) {
        interpreter->state = INTERPRETER_IDLE;
    }
    if (interpreter->state == INTERPRETER_ENDED) {
        interpreter_trace(interpreter, interpreter->clock, HAL_TRACE_END, 0);
    }
}

static void end_move(struct interpreter *interpreter)
{
    const struct mover *mover = interpreter->mover;
    int64_t steps = (int64_t)mover_steps_made(mover);
    interpreter->under_way = false;
    interpreter_trace(interpreter, mover_end_tick(mover), HAL_TRACE_DONE, signed_steps(interpreter, steps));
    interpreter_raise_clock(interpreter, mover_end_tick(mover));
    spend_guards(interpreter, mover_stop_cause(mover));
}

/* T41 and C41, whoever has switched them, get to a motor here: where it stands, and before its next move. */
void interpreter_watch_move(struct interpreter *interpreter, uint64_t now_ticks)
{
    struct mover *mover = interpreter->mover;
    bool ended = false;
    if (interpreter->under_way) {
        mover_poll(mover);
        if (mover_take_mark(mover)) {
            set_order_outputs(interpreter, now_ticks);
        }
        if (mover_is_moving(mover)) {
            return;
        }
        end_move(interpreter);
        ended = true;
    }
    mover_connect(mover, !interpreter->io->simulating);
    if (ended) {
        leave_move(interpreter, mover_stop_cause(mover), now_ticks);
    }
}

void interpreter_stop(struct interpreter *interpreter, enum hal_trace_stop cause, uint64_t now_ticks)
{
    if (interpreter->under_way) {
        mover_stop(interpreter->mover, cause);
    }
    /* The mover tells of a stop that it begins, not of one that comes while it is stopping already. */
    if (!interpreter->under_way || mover_stop_cause(interpreter->mover) != cause) {
        interpreter_trace(interpreter, now_ticks, HAL_TRACE_STOP, cause);
    }
}

void interpreter_continue(struct interpreter *interpreter, uint64_t now_ticks)
{
    interpreter->resuming = false;
    interpreter->state = interpreter->resume_state;
    interpreter_raise_clock(interpreter, now_ticks);
    if (interpreter->state == INTERPRETER_WAIT_TIME) {
        interpreter->clock = now_ticks + interpreter->wait_left;
    } else if (interpreter->state == INTERPRETER_MOVING) {
        start_order(interpreter, now_ticks);
    }
}
