#include "interpreter_private.h"

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
    interpreter->error = INTERPRETER_ERROR_NONE;
    interpreter->order.start_speed_steps_per_s = START_STEPS_PER_S;
    interpreter->order.speed_steps_per_s = SPEED_STEPS_PER_S;
    interpreter->order.accel_steps_per_s2 = ACCELERATION_STEPS_PER_S2;
    interpreter->order.steps = 0;
    interpreter->order.backward = false;
    interpreter->compound.order.sections = 0;
    interpreter->compound.done = false;
    interpreter->order.mark_outputs = 0;
    interpreter->loop_depth = 0;
    interpreter->call_depth = 0;
    interpreter->guards = (struct axis_guards){0};
}

void interpreter_init(struct interpreter *interpreter, unsigned motor, struct axis *axis,
                      struct interpreter_shared *shared)
{
    *interpreter = (struct interpreter){
        .axis = axis,
        .shared = shared,
        .motor = (uint8_t)motor,
        .state = INTERPRETER_IDLE,
    };
    interpreter_clear(interpreter);
}

void interpreter_fail(struct interpreter *interpreter, enum interpreter_error error, uint64_t now_ticks)
{
    (void)axis_stop(interpreter->axis, AXIS_CAUSE_FAULT);
    interpreter->state = INTERPRETER_FAILED;
    interpreter->error = (uint8_t)error;
    interpreter->clock = now_ticks;
    interpreter_trace(interpreter, now_ticks, HAL_TRACE_ERROR, error);
}

bool interpreter_has_run_all(const struct interpreter *interpreter)
{
    return interpreter->next == interpreter->memory.written;
}

bool interpreter_is(const struct interpreter *interpreter, enum interpreter_trait trait)
{
    static const uint8_t traits[] = {
#define X(name, of, status) [INTERPRETER_##name] = (of),
        INTERPRETER_STATES(X)
#undef X
    };
    return (traits[interpreter->state] & trait) != 0;
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
