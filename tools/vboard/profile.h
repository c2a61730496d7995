/*
 * Where the cycles of a run went, instruction by instruction, for each exception and for the program outside of
 * them. All of it together is the time that has passed: each cycle is counted once.
 */
#ifndef PROFILE_H
#define PROFILE_H

#include <stdbool.h>
#include <stdint.h>

#include "cost.h"
#include "clock.h"
#include "nvic.h"
#include "outfile.h"
#include "report.h"
#include "stats.h"

/* What is no instruction. */
enum profile_place {
    PROFILE_OTHER,
    PROFILE_ENTRY, /* of an exception, a tail-chained one too */
    PROFILE_EXIT,
    PROFILE_PLACES,
};

struct profile_row {
    uint64_t count;      /* how often it was executed */
    uint64_t cycles;     /* until what comes next: a refill and waiting included */
    uint64_t bus_cycles; /* of those: waiting for APB */
    uint32_t peripheral; /* the register that it accessed last; 0: none */
};

/* Of one exception, or of the program outside. */
struct profile_table {
    struct profile_row *code[COST_REGIONS]; /* COST_REGION_HALFWORDS each, as in cost_find */
    struct profile_row place[PROFILE_PLACES];
};

struct profile_wires {
    const struct clock *clock;
    struct report *report;
    const struct stats *stats; /* which know the present exception */
};

struct profile {
    struct profile_wires wires;
    struct outfile file;
    bool on;
    uint64_t mark;           /* what was before has been counted */
    struct profile_row *row; /* what the cycles since then belong to */
    struct profile_table table[NVIC_EXCEPTIONS];
};

/* False after a complaint. Nothing is counted unless a path is given. */
bool profile_open(struct profile *profile, const char *path);

/* Begins to count anew. */
void profile_reset(struct profile *profile);

/* The instruction that ran is over, and another comes. */
void profile_at(struct profile *profile, uint32_t address);

/* The instruction that ran is over, and what comes is no instruction. */
void profile_pause(struct profile *profile);

/* What has passed since then was a place of the present exception. */
void profile_place(struct profile *profile, enum profile_place place);

/* The present instruction accesses a register and has waited for it. */
void profile_bus(struct profile *profile, uint32_t address, uint64_t cycles);

/* Writes the rows. False after a complaint. */
bool profile_close(struct profile *profile);
void profile_discard(struct profile *profile);

#endif
