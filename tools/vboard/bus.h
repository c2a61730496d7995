/*
 * The buses to the peripherals: which block an address belongs to, whether its clock runs, how long an access takes,
 * and a loud end of the run if it leads to a register that is not known, not clocked or not accessible that way.
 */
#ifndef BUS_H
#define BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "conditions.h"
#include "core.h"
#include "cpu.h"
#include "profile.h"
#include "rcc.h"
#include "report.h"

enum {
    BUS_BLOCKS_MAX = 28,
    BUS_APBS = 2
};

/* How many registers a peripheral has is known by its model: reads and writes answer false for one it does not have.
 * `mask` has ones where bits are written. */
typedef bool bus_reader(void *model, uint32_t offset, uint32_t *value);
typedef bool bus_writer(void *model, uint32_t offset, uint32_t value, uint32_t mask);

/* Whether a register has 32 bits that mean something, so that it must be written by words. */
typedef bool bus_width(const void *model, uint32_t offset);

/* A row of RM0090 table 1. */
struct bus_block {
    const char *name;
    void *model;
    bus_reader *read;
    bus_writer *write;
    bus_width *is_wide; /* null: half-words will do everywhere */
    uint32_t base;
    uint8_t least_bytes;  /* the narrowest access: 1, 2 or 4 bytes */
    uint8_t clock_offset; /* of its clock enable register in RCC; 0: always on */
    uint8_t clock_bit;
};

/* A write that has left the processor and acts when it arrives. */
struct bus_write {
    const struct bus_block *block;
    uint32_t address;
    uint32_t value;
    uint32_t mask;
    uint32_t at; /* the instruction that wrote */
};

struct bus_wires {
    struct clock *clock;
    struct cpu *cpu;
    struct report *report;
    struct profile *profile;
    const struct rcc *rcc; /* tells whose clock is on */
    const struct conditions *conditions;
    struct core *core;
    uint32_t apb_wait; /* cycles by which an access to an APB at a quarter of HCLK takes longer */
};

struct bus {
    struct bus_wires wires;
    struct bus_block block[BUS_BLOCKS_MAX];
    unsigned blocks;
    uint64_t apb_busy_until;        /* the processor's write that is on its way has arrived */
    uint64_t taken_until[BUS_APBS]; /* and the access to APB1 and to APB2 of whoever came last */
    struct bus_write write;         /* there is one at most: the next access to APB waits for it */
};

/* Maps the peripherals into the processor's addresses. False: there is not memory enough. */
bool bus_init(struct bus *bus, struct bus_wires wires);

/* Puts a model at its addresses. */
void bus_attach(struct bus *bus, struct bus_block block);

/* What is on its way is lost. */
void bus_reset(struct bus *bus);

/* When the processor's last write has arrived at its peripheral. */
uint64_t bus_idle_cycle(const struct bus *bus);

bool bus_is_apb1(uint32_t address);

bool bus_is_apb2(uint32_t address);

/* A DMA controller takes the bus of an address on APB1 or APB2 for an access that is ready at a cycle: when it arrives.
 * Then it is delivered, or what is there fetched. */
uint64_t bus_take_apb(struct bus *bus, uint32_t address, uint64_t cycle);
void bus_deliver(struct bus *bus, uint32_t address, unsigned bytes, uint32_t value, uint64_t cycle);
uint32_t bus_fetch(struct bus *bus, uint32_t address, unsigned bytes, uint64_t cycle);

#endif
