/*
 * The paths that a program can take from command to command, those after its last reset.
 *
 * A command is named by its index. A call steps to the command after it if its subroutine can come to an end; what a
 * subroutine does in between belongs to the flow that starts at its label. A set of commands is a byte for each, 1 for
 * those that belong to it.
 */
#ifndef FLOW_H
#define FLOW_H

#include <stdbool.h>
#include <stdint.h>

#include "listing.h"

enum {
    FLOW_LABELS = 81,  /* one more than the greatest label */
    FLOW_NEXT_MAX = 3, /* commands that may run directly after one, that of a subroutine included */
    FLOW_NONE = -1,
};

struct flow {
    const struct listing_command *commands;
    uint32_t count;
    bool has_guards;                  /* something ends a run without end and lets the program go on */
    int64_t label[FLOW_LABELS];       /* where each stands, of several the last one; FLOW_NONE: nowhere */
    bool ends[FLOW_LABELS];           /* whether some path leads from a label to the end of its subroutine */
    bool ends_at_once[FLOW_LABELS];   /* whether such a path takes no time */
    uint8_t *main;                    /* commands that run outside any subroutine */
    uint8_t *subroutine[FLOW_LABELS]; /* those of a subroutine that can be called; otherwise null */
    uint8_t *run;                     /* all that can ever run */
};

/* False if there is not memory enough; in both cases to be discarded. */
bool flow_read(struct flow *flow, const struct listing *listing);

unsigned flow_opcode(const struct flow *flow, uint32_t index);

/* The number of a command that is a label, jump or call, else any. */
unsigned flow_label(const struct flow *flow, uint32_t index);

bool flow_is_jump(unsigned opcode);

/* Whether a command takes time, so that a loop with it is not busy. */
bool flow_waits(unsigned opcode);

/* The commands that may run directly after one, subroutines skipped; returns how many. */
unsigned flow_next(const struct flow *flow, uint32_t index, uint32_t next[FLOW_NEXT_MAX]);

/* The same before any time has gone by. */
unsigned flow_next_at_once(const struct flow *flow, uint32_t index, uint32_t next[FLOW_NEXT_MAX]);

/* The same as flow_next, and a call leads into its subroutine too. */
unsigned flow_next_inside(const struct flow *flow, uint32_t index, uint32_t next[FLOW_NEXT_MAX]);

/* A new set of no commands; null if there is not memory enough. */
uint8_t *flow_new_set(const struct flow *flow);

/* Adds all that can run after the commands of a set, in and after subroutines, too. */
void flow_spread(const struct flow *flow, uint8_t *set);

/* Adds all from which the commands of a set can be reached so. */
void flow_spread_back(const struct flow *flow, uint8_t *set);

/* Adds all from which the commands of a set can be reached by flow_next. */
void flow_spread_back_inside(const struct flow *flow, uint8_t *set);

void flow_discard(struct flow *flow);

#endif
