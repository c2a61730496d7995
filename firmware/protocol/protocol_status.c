#include "protocol_status.h"

#include <assert.h>

#include "hal_board.h"
#include "hal_flash.h"

/* What masters read must not change with the order of our own lists. */
static_assert(HAL_BOARD_CAUSE_POWER == 0 && HAL_BOARD_CAUSE_FAULT == 3, "causes are numbered in messages.md");
static_assert(UNIT_VARIABLE_FIRST + UNIT_VARIABLES == PROTOCOL_WAITS_TIME, "a time is no variable");
static_assert(INTERPRETER_ERROR_NO_LABEL == 1 && INTERPRETER_ERROR_NO_CRYSTAL == 10,
              "errors are numbered in messages.md");

static uint8_t state_bits(const struct interpreter *interpreter)
{
    switch ((enum interpreter_state)interpreter->state) {
    case INTERPRETER_RUNNING:
    case INTERPRETER_MOVING:
        return PROTOCOL_STATUS_RUNNING;
    case INTERPRETER_IDLE:
        return interpreter_is_idle(interpreter) ? 0 : PROTOCOL_STATUS_RUNNING;
    case INTERPRETER_HELD:
    case INTERPRETER_WAIT_TIME:
    case INTERPRETER_WAIT_LEVEL:
        return PROTOCOL_STATUS_RUNNING | PROTOCOL_STATUS_WAITING;
    case INTERPRETER_STOPPED:
        return PROTOCOL_STATUS_STOPPED;
    case INTERPRETER_ENDED:
        return PROTOCOL_STATUS_ENDED;
    case INTERPRETER_FAILED:
        return PROTOCOL_STATUS_FAILED;
    case INTERPRETER_RESETTING:
        break;
    }
    return 0;
}

static uint8_t motor_bits(const struct interpreter *interpreter)
{
    unsigned bits = state_bits(interpreter);
    bits |= mover_is_moving(interpreter->mover) ? PROTOCOL_STATUS_MOVING : 0U;
    bits |= interpreter->mover->connected ? 0U : PROTOCOL_STATUS_SIMULATED;
    return (uint8_t)bits;
}

static uint8_t awaited(const struct interpreter *interpreter)
{
    if (interpreter->state == INTERPRETER_WAIT_LEVEL) {
        return (uint8_t)(interpreter->wait_number | (interpreter->wait_level ? PROTOCOL_WAITS_HIGH : 0U));
    }
    if (interpreter->state == INTERPRETER_WAIT_TIME) {
        return PROTOCOL_WAITS_TIME;
    }
    return interpreter->state == INTERPRETER_HELD ? PROTOCOL_WAITS_RELEASE : 0U;
}

static uint8_t switch_bits(const struct io *io)
{
    unsigned bits = hal_board_may_move() ? 0U : PROTOCOL_STATUS_NO_CRYSTAL;
    bits |= hal_board_may_start_programs() ? 0U : PROTOCOL_STATUS_NOT_STARTED;
    bits |= io->memory_locked ? PROTOCOL_STATUS_LOCKED : 0U;
    bits |= io->simulating ? PROTOCOL_STATUS_SIMULATING : 0U;
    bits |= hal_flash_is_there() ? 0U : PROTOCOL_STATUS_NO_STORE;
    return (uint8_t)bits;
}

void protocol_status_read(struct protocol_status *status, const struct interpreter interpreters[UNIT_MOTORS])
{
    const struct io *io = interpreters[0].io;
    *status = (struct protocol_status){
        .inputs = io_inputs(io),
        .outputs = io->outputs,
        .cause = (uint8_t)hal_board_start_cause(),
        .switches = switch_bits(io),
        .late_steps = hal_board_late_steps(),
    };
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        const struct interpreter *interpreter = &interpreters[motor];
        status->motors[motor] = motor_bits(interpreter);
        status->errors[motor] = interpreter->error;
        status->waits[motor] = awaited(interpreter);
        status->positions_steps[motor] = mover_position_steps(interpreter->mover);
    }
}

/* The low byte first. */
static void put_number(struct text *answer, uint64_t value, unsigned bytes)
{
    for (unsigned i = 0; i < bytes; i++) {
        text_put_byte(answer, (uint8_t)(value >> 8U * i & 0xFFU));
    }
}

void protocol_status_put(const struct protocol_status *status, struct text *answer)
{
    text_put_byte(answer, PROTOCOL_STATUS_LAYOUT);
    text_put_byte(answer, status->inputs);
    text_put_byte(answer, status->outputs);
    text_put_byte(answer, status->cause);
    text_put_byte(answer, status->switches);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        text_put_byte(answer, status->motors[motor]);
    }
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        text_put_byte(answer, status->errors[motor]);
    }
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        put_number(answer, (uint64_t)status->positions_steps[motor], 8);
    }
    put_number(answer, status->late_steps, 4);
    for (unsigned count = 0; count < PROTOCOL_LINE_COUNTS; count++) {
        put_number(answer, status->line_counts[count], 4);
    }
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        text_put_byte(answer, status->waits[motor]);
    }
}
