/*
 * Inputs and outputs of a unit, and whether the outputs reach their pins.
 *
 * Comes in: the levels at the pins, sampled once for all motors; what main sets. Goes out: the same levels until the
 * next sample; the output pins. Main only, but for the inputs: the tick interrupt samples and reads them, too.
 */
#ifndef IO_H
#define IO_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "base_limits.h"

struct io {
    _Atomic uint8_t inputs; /* as sampled last; bit 0 is input 1 */
    uint8_t outputs;        /* as they were set; bit 0 is output 1 */
    bool connected;         /* the pins show `outputs`; otherwise they are held at 0 */
};

/* Everything 0, outputs connected; writes the output pins. */
void io_init(struct io *io);

/* Samples the inputs; true if one has changed. Tick interrupt, or main while it holds that off. */
bool io_sample(struct io *io);

/* The inputs as sampled last; bit 0 is input 1. Main and tick interrupt. */
uint8_t io_inputs(const struct io *io);

/* Sets or clears an output, 0 to UNIT_OUTPUTS - 1; `now_ticks` and `motor` (1-4, 0 = the unit) are for the trace. */
void io_set(struct io *io, unsigned output, bool level, unsigned motor, uint64_t now_ticks);

/* Connects the outputs to their pins, or disconnects them and holds the pins at 0; at once. */
void io_connect(struct io *io, bool connected);

#endif
