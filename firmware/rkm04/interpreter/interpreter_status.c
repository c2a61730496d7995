#include "interpreter_status.h"

#include <assert.h>

/* What masters read must not change with the order of our own lists. */
static_assert(INTERPRETER_ERROR_NO_LABEL == 1 && INTERPRETER_ERROR_NO_CRYSTAL == 10,
              "errors are numbered in messages.md");
static_assert((unsigned)PROGRAM_VARIABLE_FIRST + (unsigned)PROGRAM_VARIABLES == (unsigned)INTERPRETER_WAITS_TIME,
              "a time is no variable");

static unsigned state_bits(const struct interpreter *interpreter)
{
    static const uint8_t bits[] = {
#define X(name, traits, status) [INTERPRETER_##name] = (status),
        INTERPRETER_STATES(X)
#undef X
    };
    bool rests = interpreter->state == INTERPRETER_IDLE && interpreter_is_idle(interpreter);
    return rests ? 0U : bits[interpreter->state];
}

static unsigned awaited(const struct interpreter *interpreter)
{
    if (interpreter->state == INTERPRETER_WAIT_LEVEL) {
        return interpreter->wait.number | (interpreter->wait.level ? INTERPRETER_WAITS_HIGH : 0U);
    }
    if (interpreter->state == INTERPRETER_WAIT_TIME) {
        return INTERPRETER_WAITS_TIME;
    }
    return interpreter->state == INTERPRETER_HELD ? INTERPRETER_WAITS_RELEASE : 0U;
}

struct interpreter_status interpreter_status(const struct interpreter *interpreter)
{
    const struct axis *axis = interpreter->axis;
    unsigned bits = state_bits(interpreter);
    bits |= axis_is_moving(axis) ? INTERPRETER_STATUS_MOVING : 0U;
    bits |= axis_is_simulated(axis) ? INTERPRETER_STATUS_SIMULATED : 0U;
    return (struct interpreter_status){
        .bits = (uint8_t)bits,
        .error = interpreter->error,
        .waits = (uint8_t)awaited(interpreter),
    };
}

struct interpreter_progress interpreter_progress(const struct interpreter *interpreter)
{
    const struct axis *axis = interpreter->axis;
    return (struct interpreter_progress){
        .steps = axis_is_moving(axis) ? axis_steps_made(axis) : 0,
        .command = interpreter->place,
    };
}

bool interpreter_has_failed(const struct interpreter *interpreter)
{
    return interpreter->state == INTERPRETER_FAILED;
}

int64_t interpreter_position_steps(const struct interpreter *interpreter)
{
    return axis_position_steps(interpreter->axis);
}

unsigned interpreter_corners(const struct interpreter *interpreter, struct motion_corner corners[MOTION_CORNERS_MAX])
{
    return axis_corners(interpreter->axis, corners);
}

uint32_t interpreter_list(const struct interpreter *interpreter, uint8_t *text, uint32_t capacity)
{
    return program_memory_list(&interpreter->memory, text, capacity);
}
