/*
 * What goes wrong on request: --fault MS:WHAT, each once, at a time. The fault ends with the next reset.
 */
#ifndef FAULTS_H
#define FAULTS_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "cpu.h"
#include "dma.h"
#include "flash.h"
#include "image.h"
#include "memory.h"
#include "nvic.h"
#include "reset.h"

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
    FAULT_DMA,   /* a stream loads from nowhere, or stores there */
    FAULT_SLOW,  /* a stream waits long for its memory */
    FAULT_POWER, /* power goes, and comes back at once */
    FAULT_RESET, /* the reset pin is pulled low, for a moment */
};

struct fault {
    uint64_t ps;
    enum fault_kind kind;
    uint32_t
        address; /* FAULT_LOSE, FAULT_FIND: the exception; FAULT_DMA, FAULT_SLOW: the stream, those of DMA2 from 8 on */
    uint32_t value;
};

struct faults_wires {
    struct clock *clock;
    struct cpu *cpu;
    struct memory *memory;
    struct dma *dma;
    struct flash *flash;
    struct nvic *nvic;
    struct reset *reset;
    const struct image *image; /* whose symbols are places */
};

struct faults {
    struct faults_wires wires;
    struct fault fault[2 * FAULTS_MAX]; /* sorted by time */
    unsigned count;
    unsigned next;
    unsigned due; /* those that wait until emulation stands */
};

void faults_init(struct faults *faults, struct faults_wires wires);

/* Reads up to FAULTS_MAX faults, as MS:WHAT; the program has been loaded. False after a complaint. */
bool faults_open(struct faults *faults, const char *const texts[], unsigned count);

/* Does what is due, between two stretches of emulation. */
void faults_apply(struct faults *faults);

/* What a reset ends. */
void faults_reset(struct faults *faults);

#endif
