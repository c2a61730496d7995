/*
 * What an instruction costs: the static part of the cycle model, decoded once for each address and kept in a table
 * (README.md, "Cycle model"; Cortex-M4 technical reference manual, section 3.3).
 */
#ifndef COST_H
#define COST_H

#include <stdbool.h>
#include <stdint.h>

#include "memory.h"

/* Regions of code: what is at address 0, the flash, the SRAM; bits 27 and 29 of an address tell which. */
enum {
    COST_REGIONS = 3,
    COST_REGION_HALFWORDS = 0x80000,
};

enum cost_flag {
    COST_PIPELINED = 1 << 0,  /* a load, or a store with a register offset: one cycle less right after a load */
    COST_LOAD = 1 << 1,       /* a load: what follows may be pipelined with it */
    COST_FLASH_DATA = 1 << 2, /* reads a literal from flash: costs its wait states as well */
    COST_IN_IT = 1 << 3,      /* inside an IT block: emulation must not stop here */
    COST_SLOW = 1 << 4,       /* has a kind that must be looked at each time */
    COST_OPENS_IT = 1 << 5,   /* is IT */
    COST_IN_LINE = 1 << 8,    /* only of the instruction before: what follows it has not been jumped to */
};

/* The number of the link register in an instruction. */
enum {
    COST_REGISTER_LR = 14
};

/* What must be looked at before such an instruction is executed. */
enum cost_kind {
    COST_PLAIN,
    COST_UNKNOWN,     /* not decoded yet */
    COST_IT,          /* opens an IT block */
    COST_DIVIDE,      /* UDIV, SDIV: the cost depends on the operands */
    COST_BARRIER,     /* DSB: waits for a write that is on its way */
    COST_MASKS,       /* CPS, MSR: an interrupt may become possible */
    COST_SLEEP,       /* WFI */
    COST_SLEEP_EVENT, /* WFE */
    COST_EVENT,       /* SEV */
    COST_FLOAT,       /* needs the coprocessor enabled */
    COST_END,         /* the run ends here */
    COST_HOLD,        /* a fault: it does not get past this */
};

struct cost {
    uint8_t cycles;
    uint8_t flags; /* enum cost_flag */
    uint8_t kind;  /* enum cost_kind */
    uint8_t more;  /* COST_IT: bytes of the block after it. COST_DIVIDE: registers, dividend in the low four bits */
};

struct cost_table {
    struct cost *entry[COST_REGIONS]; /* COST_REGION_HALFWORDS each */
    uint64_t capstone;                /* its handle */
    void *instruction;                /* its buffer */
    uint32_t end_address;             /* where the run ends; odd: nowhere */
    uint32_t hold_address;            /* where a fault holds the processor; odd: nowhere */
    bool shared_bus;                  /* code in RAM waits for data from where it is fetched */
};

bool cost_init(struct cost_table *table);
void cost_discard(struct cost_table *table);

/* Forgets everything, for instance because memory with code has changed. */
void cost_forget(struct cost_table *table);

static inline unsigned cost_region(uint32_t address)
{
    return (address >> 27 & 1U) | (address >> 28 & 2U);
}

static inline struct cost *cost_find(const struct cost_table *table, uint32_t address)
{
    return &table->entry[cost_region(address)][(address & 0xFFFFFU) >> 1];
}

/* Decodes the instruction at `address`. `previous` is the one before it if control came in line, else odd. */
void cost_decode(struct cost_table *table, struct memory *memory, uint32_t address, uint32_t previous);

#endif
