/*
 * What the fuzzers of whole units share on the host machine: where its time begins, and what goes wrong with its flash.
 */
#ifndef FUZZ_HOST_H
#define FUZZ_HOST_H

#include <stdbool.h>
#include <stdint.h>

#include "base_tick.h"
#include "fuzz_stream.h"
#include "host_machine.h"

enum {
    FUZZ_EPOCHS = 4,
    FUZZ_AHEAD_TICKS = 512 * TICKS_PER_US,
    FUZZ_LATE_TICKS = 5 * TICKS_PER_US,          /* the tick interrupt after an edge, as on a board */
    FUZZ_APART_TICKS_MIN = 5 * TICKS_PER_US - 2, /* pulses of a motor */
};

/* The tick at which a run at an epoch begins. */
uint64_t fuzz_epoch_tick(unsigned epoch);

/* A number that a digest becomes with one more. */
#define FUZZ_DIGEST_SEED UINT64_C(0xCBF29CE484222325)
uint64_t fuzz_digest(uint64_t digest, uint64_t number);

/* An operation of the flash that fails, does nothing and says nothing, or is the last before the power fails, by the
 * low 2 bits; the others say how many there are before it. False: it is another trouble. */
bool fuzz_order_flash_fault(struct host_machine *machine, unsigned operand);

/* An edge at an input: its time is a byte of the stream, squared, in units of 10 us. It replaces the one before it. */
void fuzz_order_edge(struct host_machine *machine, struct host_input *edge, struct fuzz_stream *stream,
                     unsigned operand);

#endif
