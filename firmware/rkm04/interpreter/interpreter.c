#include "interpreter_private.h"

/* Has X acted? The axis stops a move by itself; this sees all the rest, and an X while another stop is going on. */
static void watch_total_stop(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (!interpreter_is(interpreter, INTERPRETER_RUNS) ||
        (interpreter_shared_inputs(interpreter->shared) & interpreter->guards.abort_high) == 0) {
        return;
    }
    interpreter_stop(interpreter, AXIS_CAUSE_ABORT, now_ticks);
    interpreter->state = INTERPRETER_ENDED;
    if (!axis_is_busy(interpreter->axis)) {
        interpreter_trace(interpreter, now_ticks, HAL_TRACE_END, 0);
    }
}

/* Each advance_ function does one thing that can be done now, or returns false: nothing changes by itself before the
 * next event or the clock. */

static bool advance_running(struct interpreter *interpreter, uint64_t now_ticks)
{
    const struct program_memory *memory = &interpreter->memory;
    uint32_t oldest = program_memory_oldest(memory);
    if (now_ticks < interpreter->clock) {
        interpreter->state = INTERPRETER_WAIT_TIME;
        return true;
    }
    if (interpreter->next < oldest) {
        interpreter->next = oldest;
    }
    if (interpreter_has_run_all(interpreter)) {
        interpreter->state = INTERPRETER_IDLE;
        interpreter_trace(interpreter, now_ticks, HAL_TRACE_END, 0);
        return false;
    }
    struct program_instruction instruction = program_memory_at(memory, interpreter->next);
    interpreter->next++;
    interpreter->place = interpreter->next;
    interpreter_trace(interpreter, now_ticks, HAL_TRACE_COMMAND, interpreter->place);
    interpreter_run(interpreter, &instruction, now_ticks);
    return true;
}

static bool advance_idle(struct interpreter *interpreter)
{
    if (interpreter_has_run_all(interpreter)) {
        return false;
    }
    interpreter->state = INTERPRETER_RUNNING;
    interpreter_trace(interpreter, interpreter->clock, HAL_TRACE_START, 0);
    return true;
}

static bool is_released(const struct interpreter *interpreter)
{
    return program_memory_is_released(&interpreter->memory, interpreter->place - 1U);
}

static bool advance_held(struct interpreter *interpreter)
{
    if (!is_released(interpreter)) {
        return false;
    }
    interpreter_raise_clock(interpreter, interpreter->release_tick);
    interpreter->state = INTERPRETER_RUNNING;
    return true;
}

static bool advance_wait_time(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (now_ticks < interpreter->clock) {
        return false;
    }
    interpreter->state = INTERPRETER_RUNNING;
    return true;
}

static bool advance_wait_level(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (interpreter_shared_level(interpreter->shared, interpreter->wait.number) != interpreter->wait.level) {
        return false;
    }
    interpreter_raise_clock(interpreter, now_ticks);
    interpreter->state = INTERPRETER_RUNNING;
    return true;
}

static bool interpreter_advance(struct interpreter *interpreter, uint64_t now_ticks)
{
    switch ((enum interpreter_state)interpreter->state) {
    case INTERPRETER_RUNNING:
        return advance_running(interpreter, now_ticks);
    case INTERPRETER_IDLE:
        return advance_idle(interpreter);
    case INTERPRETER_HELD:
        return advance_held(interpreter);
    case INTERPRETER_WAIT_TIME:
        return advance_wait_time(interpreter, now_ticks);
    case INTERPRETER_WAIT_LEVEL:
        return advance_wait_level(interpreter, now_ticks);
    case INTERPRETER_MOVING:
    case INTERPRETER_STOPPED:
    case INTERPRETER_RESUMING:
    case INTERPRETER_RESETTING:
    case INTERPRETER_ENDED:
    case INTERPRETER_FAILED:
        break;
    }
    return false;
}

/* A rest that the end of a move has begun, and whose guard had its level already: nothing else brings main back. */
static bool has_ended_move(const struct interpreter *interpreter)
{
    return axis_is_busy(interpreter->axis) && !axis_is_moving(interpreter->axis);
}

uint64_t interpreter_poll(struct interpreter *interpreter, uint64_t now_ticks)
{
    for (unsigned i = 0; i < INTERPRETER_SLICE_COMMANDS; i++) {
        interpreter_watch_move(interpreter, now_ticks);
        watch_total_stop(interpreter, now_ticks);
        if (!interpreter_advance(interpreter, now_ticks) && !has_ended_move(interpreter)) {
            return interpreter->state == INTERPRETER_WAIT_TIME ? interpreter->clock : TICK_NEVER;
        }
    }
    return now_ticks;
}

bool interpreter_is_idle(const struct interpreter *interpreter)
{
    if (axis_is_busy(interpreter->axis)) {
        return false;
    }
    if (interpreter->state == INTERPRETER_IDLE) {
        return interpreter_has_run_all(interpreter);
    }
    return interpreter_is(interpreter, INTERPRETER_RESTS) ||
           (interpreter->state == INTERPRETER_HELD && !is_released(interpreter));
}
