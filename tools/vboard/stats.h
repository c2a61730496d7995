/*
 * What the exceptions of a run have cost. The cycles of one count from its entry to the end of its return, without
 * those of exceptions that interrupted it; a tail-chained one begins where the one before ends.
 */
#ifndef STATS_H
#define STATS_H

#include <stdint.h>

#include "clock.h"
#include "cpu.h"
#include "nvic.h"

enum {
    STATS_BINS = 8192, /* of one cycle each; the last one takes all that is longer */
    STATS_DEPTH = 32,  /* exceptions inside one another, at most the number of priorities and faults */
};

struct stats_vector {
    uint64_t count;
    uint64_t cycles;
    uint64_t least;
    uint64_t most;
    uint64_t latency_most; /* from the request to the first instruction of the handler */
    uint32_t bin[STATS_BINS];
};

struct stats_frame {
    unsigned exception;
    uint64_t begin;
    uint64_t inner; /* cycles of what interrupted it */
};

struct stats_wires {
    const struct clock *clock;
    const struct cpu *cpu;
    const struct nvic *nvic;
};

struct stats {
    struct stats_wires wires;
    struct stats_vector vector[NVIC_EXCEPTIONS];
    struct stats_frame frame[STATS_DEPTH];
    unsigned depth;
    uint64_t begin;
    uint64_t tail_chains;
    uint64_t faults;
    uint32_t fault_bits;  /* of CFSR, of the first fault */
    uint32_t fault_at;    /* its instruction or stack pointer */
    uint64_t since_cycle; /* what is counted began here */
    uint64_t since_asleep;
    uint64_t since_stalled;
    uint64_t since_instructions;
};

/* Begins to count anew. */
void stats_reset(struct stats *stats);

/* An entry begins at a cycle; then its exception is known; then it is over. */
void stats_begin(struct stats *stats, uint64_t cycle);
void stats_enter(struct stats *stats, unsigned exception);
void stats_leave(struct stats *stats, unsigned exception);

void stats_note_fault(struct stats *stats, uint32_t bits, uint32_t at);

/* The median of the cycles of a vector. */
uint64_t stats_median(const struct stats_vector *vector);

#endif
