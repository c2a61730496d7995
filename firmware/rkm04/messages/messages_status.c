#include "messages_status.h"

#include <assert.h>

#include "hal_board.h"
#include "hal_flash.h"

/* What masters read must not change with the order of our own lists. */
static_assert(HAL_BOARD_CAUSE_POWER == 0 && HAL_BOARD_CAUSE_FAULT == 3, "causes are numbered in messages.md");

static uint8_t switch_bits(const struct interpreter_shared *shared)
{
    unsigned bits = hal_board_may_move() ? 0U : MESSAGES_STATUS_NO_CRYSTAL;
    bits |= hal_board_may_start_programs() ? 0U : MESSAGES_STATUS_NOT_STARTED;
    bits |= shared->memory_locked ? MESSAGES_STATUS_LOCKED : 0U;
    bits |= interpreter_shared_is_simulating(shared) ? MESSAGES_STATUS_SIMULATING : 0U;
    bits |= hal_flash_is_there() ? 0U : MESSAGES_STATUS_NO_STORE;
    bits |= hal_board_steps_are_timed() ? 0U : MESSAGES_STATUS_UNTIMED;
    return (uint8_t)bits;
}

void messages_status_read(struct messages_status *status, const struct interpreter interpreters[UNIT_MOTORS],
                          const struct interpreter_shared *shared)
{
    *status = (struct messages_status){
        .inputs = interpreter_shared_inputs(shared),
        .outputs = interpreter_shared_outputs(shared),
        .cause = (uint8_t)hal_board_start_cause(),
        .switches = switch_bits(shared),
        .late_steps = hal_board_late_steps(),
    };
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        struct interpreter_status now = interpreter_status(&interpreters[motor]);
        status->motors[motor] = now.bits;
        status->errors[motor] = now.error;
        status->waits[motor] = now.waits;
        status->positions_steps[motor] = interpreter_position_steps(&interpreters[motor]);
    }
}

/* The low byte first. */
static void put_number(struct text *answer, uint64_t value, unsigned bytes)
{
    for (unsigned i = 0; i < bytes; i++) {
        text_put_byte(answer, (uint8_t)(value >> 8U * i & 0xFFU));
    }
}

void messages_status_put(const struct messages_status *status, struct text *answer)
{
    text_put_byte(answer, MESSAGES_STATUS_LAYOUT);
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
    for (unsigned count = 0; count < MESSAGES_LINE_COUNTS; count++) {
        put_number(answer, status->line_counts[count], 4);
    }
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        text_put_byte(answer, status->waits[motor]);
    }
}
