#include "interpreter_shared.h"

#include <assert.h>

#include "hal_trace.h"

static_assert(PROGRAM_VARIABLES <= 16, "variables have a bit of 16 each");
static_assert((unsigned)PROGRAM_VARIABLE_FIRST > (unsigned)UNIT_INPUTS &&
                  (unsigned)PROGRAM_VARIABLE_FIRST > (unsigned)UNIT_OUTPUTS,
              "numbers tell which is meant");

void interpreter_shared_init(struct interpreter_shared *shared, struct io *io)
{
    *shared = (struct interpreter_shared){.io = io};
}

bool interpreter_shared_level(const struct interpreter_shared *shared, unsigned number)
{
    bool is_variable = number >= PROGRAM_VARIABLE_FIRST;
    unsigned levels = is_variable ? shared->variables : io_inputs(shared->io);
    return (levels >> (number - (is_variable ? PROGRAM_VARIABLE_FIRST : 1U)) & 1U) != 0;
}

void interpreter_shared_set(struct interpreter_shared *shared, unsigned number, bool level, unsigned motor,
                            uint64_t now_ticks)
{
    if (number < PROGRAM_VARIABLE_FIRST) {
        io_set(shared->io, number - 1U, level, motor, now_ticks);
        return;
    }
    unsigned bit = 1U << (number - PROGRAM_VARIABLE_FIRST);
    shared->variables = (uint16_t)(level ? shared->variables | bit : shared->variables & ~bit);
    hal_trace(now_ticks, motor, HAL_TRACE_VAR, level ? (int64_t)number : -(int64_t)number);
}

uint8_t interpreter_shared_inputs(const struct interpreter_shared *shared)
{
    return io_inputs(shared->io);
}

uint8_t interpreter_shared_outputs(const struct interpreter_shared *shared)
{
    return shared->io->outputs;
}

void interpreter_shared_simulate(struct interpreter_shared *shared, bool on)
{
    io_connect(shared->io, !on);
}

bool interpreter_shared_is_simulating(const struct interpreter_shared *shared)
{
    return !shared->io->connected;
}
