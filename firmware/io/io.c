#include "io.h"

#include <assert.h>

#include "hal_io.h"
#include "hal_trace.h"

static_assert(UNIT_INPUTS <= 8 && UNIT_OUTPUTS <= 8, "inputs and outputs have a bit of a byte each");

void io_init(struct io *io)
{
    *io = (struct io){.outputs = 0};
    io_connect(io, true);
}

bool io_sample(struct io *io)
{
    uint8_t inputs = hal_io_read_inputs();
    return atomic_exchange_explicit(&io->inputs, inputs, memory_order_relaxed) != inputs;
}

uint8_t io_inputs(const struct io *io)
{
    return atomic_load_explicit(&io->inputs, memory_order_relaxed);
}

void io_set(struct io *io, unsigned output, bool level, unsigned motor, uint64_t now_ticks)
{
    unsigned bit = 1U << output;
    io->outputs = (uint8_t)(level ? io->outputs | bit : io->outputs & ~bit);
    if (io->connected) {
        hal_io_write_outputs(io->outputs);
    }
    int64_t number = (int64_t)output + 1;
    hal_trace(now_ticks, motor, HAL_TRACE_OUT, level ? number : -number);
}

void io_connect(struct io *io, bool connected)
{
    io->connected = connected;
    hal_io_write_outputs(connected ? io->outputs : 0);
}
