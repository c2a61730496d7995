/*
 * What goes wrong on request: --fault MS:WHAT, each once, at a time. The fault ends with the next reset.
 */
#ifndef FAULTS_H
#define FAULTS_H

#include <stdbool.h>
#include <stdint.h>

struct board;

enum {
    FAULTS_MAX = 16
};

enum fault_kind {
    FAULT_JUMP,  /* the program goes on at an address */
    FAULT_STACK, /* the stack pointer is somewhere else */
    FAULT_WORD,  /* a word of memory changes */
    FAULT_HOLD,  /* the processor does not get past an instruction; interrupts are served */
    FAULT_LOSE,  /* an exception is not taken any more */
    FAULT_FIND,  /* it is taken again */
    FAULT_POWER, /* power goes, and comes back at once */
    FAULT_RESET, /* the reset pin is pulled low, for a moment */
};

struct fault {
    uint64_t ps;
    enum fault_kind kind;
    uint32_t address; /* FAULT_LOSE, FAULT_FIND: the exception */
    uint32_t value;
};

struct faults {
    struct fault fault[2 * FAULTS_MAX]; /* sorted by time */
    unsigned count;
    unsigned next;
    unsigned due; /* those that wait until emulation stands */
};

/* Reads up to eight hexadecimal digits, up to `end`. */
bool faults_read_hex(const char *at, const char *end, uint32_t *value);

/* Reads what the options ask for; the program has been loaded. False after a complaint. */
bool faults_open(struct board *board);

void faults_event(struct board *board, uint64_t cycle);

/* Does what is due, between two stretches of emulation. */
void faults_apply(struct board *board);

/* What a reset ends. */
void faults_reset(struct board *board);

#endif
