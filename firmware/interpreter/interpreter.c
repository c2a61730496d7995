#include "interpreter_private.h"

#include "hal_trace.h"

enum {
    START_STEPS_PER_S = 100,
    SPEED_STEPS_PER_S = 1000,
    ACCELERATION_STEPS_PER_S2 = 2000,
};

void interpreter_trace(const struct interpreter *interpreter, uint64_t tick, enum hal_trace_event event, int64_t value)
{
    hal_trace(tick, interpreter->motor + 1U, event, value);
}

void interpreter_raise_clock(struct interpreter *interpreter, uint64_t tick)
{
    if (interpreter->clock < tick) {
        interpreter->clock = tick;
    }
}

void interpreter_align_clock(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (interpreter->clock + INTERPRETER_CLOCK_SLACK_TICKS < now_ticks) {
        interpreter->clock = now_ticks;
    }
}

void interpreter_clear(struct interpreter *interpreter)
{
    program_memory_clear(&interpreter->memory);
    interpreter->next = 0;
    interpreter->place = 0;
    interpreter->resuming = false;
    interpreter->error = INTERPRETER_ERROR_NONE;
    interpreter->start_speed = START_STEPS_PER_S;
    interpreter->speed = SPEED_STEPS_PER_S;
    interpreter->acceleration = ACCELERATION_STEPS_PER_S2;
    interpreter->steps = 0;
    interpreter->backward = false;
    interpreter->compound.sections = 0;
    interpreter->compound_done = false;
    interpreter->mark_outputs = 0;
    interpreter->loop_depth = 0;
    interpreter->call_depth = 0;
    interpreter->guard_high = 0;
    interpreter->guard_low = 0;
    interpreter->total_stop = 0;
}

void interpreter_init(struct interpreter *interpreter, unsigned motor, struct mover *mover, struct io *io)
{
    *interpreter = (struct interpreter){.mover = mover, .io = io, .motor = (uint8_t)motor, .state = INTERPRETER_IDLE};
    interpreter_clear(interpreter);
}

void interpreter_fail(struct interpreter *interpreter, enum interpreter_error error, uint64_t now_ticks)
{
    if (interpreter->under_way) {
        mover_stop(interpreter->mover, HAL_TRACE_STOP_ERROR);
    }
    interpreter->state = INTERPRETER_FAILED;
    interpreter->error = (uint8_t)error;
    interpreter->clock = now_ticks;
    interpreter_trace(interpreter, now_ticks, HAL_TRACE_ERROR, error);
}

bool interpreter_has_run_all(const struct interpreter *interpreter)
{
    return interpreter->next == interpreter->memory.written;
}

/* Whether X can act. What comes to a motor at rest begins to be executed before its first command is. */
static bool is_executing(const struct interpreter *interpreter)
{
    return interpreter->state != INTERPRETER_IDLE && interpreter->state != INTERPRETER_RESETTING &&
           interpreter->state != INTERPRETER_ENDED && interpreter->state != INTERPRETER_FAILED;
}

/* Has X acted? The mover stops a move by itself; this sees all the rest, and an X while another stop is going on. */
static void watch_total_stop(struct interpreter *interpreter, uint64_t now_ticks)
{
    if (!is_executing(interpreter) || (io_inputs(interpreter->io) & interpreter->total_stop) == 0) {
        return;
    }
    interpreter_stop(interpreter, HAL_TRACE_STOP_TOTAL, now_ticks);
    interpreter->state = INTERPRETER_ENDED;
    if (!interpreter->under_way) {
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
    if (io_level(interpreter->io, interpreter->wait_number) != interpreter->wait_level) {
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
    return interpreter->under_way && !mover_is_moving(interpreter->mover);
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
    if (interpreter->under_way) {
        return false;
    }
    switch ((enum interpreter_state)interpreter->state) {
    case INTERPRETER_IDLE:
        return interpreter_has_run_all(interpreter);
    case INTERPRETER_HELD:
        return !is_released(interpreter);
    case INTERPRETER_STOPPED:
    case INTERPRETER_ENDED:
    case INTERPRETER_FAILED:
        return true;
    case INTERPRETER_RUNNING:
    case INTERPRETER_MOVING:
    case INTERPRETER_WAIT_TIME:
    case INTERPRETER_WAIT_LEVEL:
    case INTERPRETER_RESETTING:
        break;
    }
    return false;
}

const char *interpreter_error_text(enum interpreter_error error)
{
    static const char *const texts[] = {
#define X(name, text) [INTERPRETER_ERROR_##name] = (text),
        INTERPRETER_ERRORS(X)
#undef X
    };
    return texts[error];
}
