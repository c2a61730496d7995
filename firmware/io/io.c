#include "io.h"

#include <assert.h>

#include "hal_io.h"
#include "hal_trace.h"

static_assert(UNIT_INPUTS <= 8 && UNIT_OUTPUTS <= 8, "inputs and outputs have a bit of a byte each");
static_assert(UNIT_VARIABLES <= 16, "variables have a bit of 16 each");
static_assert(UNIT_VARIABLE_FIRST > UNIT_INPUTS && UNIT_VARIABLE_FIRST > UNIT_OUTPUTS, "numbers tell which is meant");

void io_init(struct io *io)
{
    *io = (struct io){.outputs = 0};
    io_simulate(io, false);
}

bool io_sample_isr(struct io *io)
{
    uint8_t inputs = hal_io_read_inputs();
    return atomic_exchange_explicit(&io->inputs, inputs, memory_order_relaxed) != inputs;
}

uint8_t io_inputs(const struct io *io)
{
    return atomic_load_explicit(&io->inputs, memory_order_relaxed);
}

static bool bits_have(unsigned bits, unsigned place)
{
    return (bits >> place & 1U) != 0;
}

bool io_level(const struct io *io, unsigned number)
{
    if (number >= UNIT_VARIABLE_FIRST) {
        return bits_have(io->variables, number - UNIT_VARIABLE_FIRST);
    }
    return bits_have(io_inputs(io), number - 1U);
}

/* `bits` with the bit at `place` set or cleared. */
static unsigned bits_with(unsigned bits, unsigned place, bool level)
{
    unsigned bit = 1U << place;
    return level ? bits | bit : bits & ~bit;
}

void io_set(struct io *io, unsigned number, bool level, unsigned motor, uint64_t now_ticks)
{
    enum hal_trace_event event = HAL_TRACE_OUT;
    if (number >= UNIT_VARIABLE_FIRST) {
        event = HAL_TRACE_VAR;
        io->variables = (uint16_t)bits_with(io->variables, number - UNIT_VARIABLE_FIRST, level);
    } else {
        io->outputs = (uint8_t)bits_with(io->outputs, number - 1U, level);
        if (!io->simulating) {
            hal_io_write_outputs(io->outputs);
        }
    }
    hal_trace(now_ticks, motor, event, level ? (int64_t)number : -(int64_t)number);
}

void io_simulate(struct io *io, bool on)
{
    io->simulating = on;
    hal_io_write_outputs(on ? 0 : io->outputs);
}
