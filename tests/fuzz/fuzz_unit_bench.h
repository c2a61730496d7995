/*
 * A whole unit for the fuzzers, under the judge, that is ready in a few microseconds: each run begins with a copy of a
 * unit that was switched on once, at one of four epochs.
 *
 * A run has bounded work: when so many pulses and passes of main have been made it is over, and what is left of the
 * input does nothing.
 */
#ifndef FUZZ_UNIT_BENCH_H
#define FUZZ_UNIT_BENCH_H

#include <stdbool.h>
#include <stdint.h>

#include "host_machine.h"
#include "judge_unit.h"
#include "rkm04.h"

enum {
    FUZZ_PULSES_MAX = 1500,
    FUZZ_PASSES_MAX = 1500,
    FUZZ_SENT_MAX = 2 * MESSAGES_ANSWER_BYTES_MAX + 64,
};

struct fuzz_unit {
    struct judged_unit judged;
    struct rkm04 unit;
    struct judge judge;
    uint8_t answer[MESSAGES_ANSWER_BYTES_MAX];
    uint8_t sent[FUZZ_SENT_MAX]; /* by the line, since the harness has read it */
    uint32_t sent_count;
    uint32_t passes;
    struct host_machine machine; /* last: its flash is copied only when it was written */
};

/* The unit, just switched on. */
struct fuzz_unit *fuzz_unit_begin(unsigned epoch);

/* Time goes by, less if the run is over. */
void fuzz_unit_run(struct fuzz_unit *fuzz, uint64_t ticks);

bool fuzz_unit_is_over(const struct fuzz_unit *fuzz);

/* Switches the unit off and on. */
void fuzz_unit_restart(struct fuzz_unit *fuzz);

/* The end of a run: stops the fuzzer if the judge complains. */
void fuzz_unit_end(struct fuzz_unit *fuzz);

#endif
