/*
 * What the interpreters of a unit share: inputs, outputs and internal variables, by the numbers that programs use, and
 * what any program may switch for all of them.
 *
 * Main only.
 */
#ifndef INTERPRETER_SHARED_H
#define INTERPRETER_SHARED_H

#include <stdbool.h>
#include <stdint.h>

#include "../../io/io.h"
#include "../program/program_parser.h"

struct interpreter_shared {
    struct io *io;      /* its outputs are disconnected while motion is simulated (T41) */
    uint16_t variables; /* bit 0 is number 80 */
    bool memory_locked; /* T40: a full program memory refuses commands */
};

/* Everything 0; `io` must outlive it. */
void interpreter_shared_init(struct interpreter_shared *shared, struct io *io);

/* The level of an input (1-8) or variable (80-95). */
bool interpreter_shared_level(const struct interpreter_shared *shared, unsigned number);

/* Sets or clears an output (1-8) or variable (80-95); `now_ticks` and `motor` (1-4) are for the trace. */
void interpreter_shared_set(struct interpreter_shared *shared, unsigned number, bool level, unsigned motor,
                            uint64_t now_ticks);

/* All inputs as sampled last, all outputs as they were set; bit 0 is number 1. */
uint8_t interpreter_shared_inputs(const struct interpreter_shared *shared);
uint8_t interpreter_shared_outputs(const struct interpreter_shared *shared);

/* Switches simulation (T41) on or off. Outputs follow at once, STEP and DIR when their motor stands. */
void interpreter_shared_simulate(struct interpreter_shared *shared, bool on);
bool interpreter_shared_is_simulating(const struct interpreter_shared *shared);

#endif
