/*
 * Inputs, outputs and internal variables of the unit, by the numbers that programs use, and its two switches T40, T41.
 *
 * Inputs are sampled once for all motors. Main only, except io_sample_isr.
 */
#ifndef IO_H
#define IO_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "base_limits.h"

struct io {
    _Atomic uint8_t inputs; /* as sampled last; bit 0 is BI1 */
    uint8_t outputs;        /* bit 0 is BO1: what programs see and what the pins show unless simulating */
    uint16_t variables;     /* bit 0 is number 80 */
    bool memory_locked;     /* T40: a full program memory refuses commands */
    bool simulating;        /* T41: BO are disconnected and held at 0; STEP and DIR follow when their motor stands */
};

/* Everything 0, outputs connected; writes the output pins. */
void io_init(struct io *io);

/* Samples the inputs; true if one has changed. Tick interrupt or main. */
bool io_sample_isr(struct io *io);

/* The inputs as sampled last; bit 0 is BI1. */
uint8_t io_inputs(const struct io *io);

/* The level of an input (1-8) or variable (80-95). */
bool io_level(const struct io *io, unsigned number);

/* Sets or clears an output (1-8) or variable (80-95); `now_ticks` and `motor` (1-4, 0 = the unit) are for the trace. */
void io_set(struct io *io, unsigned number, bool level, unsigned motor, uint64_t now_ticks);

/* Switches simulation (T41) on or off: the outputs are disconnected from their pins or connected again at once. */
void io_simulate(struct io *io, bool on);

#endif
