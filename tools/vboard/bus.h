/*
 * The buses to the peripherals: which block an address belongs to, whether its clock runs, how long an access takes,
 * and a loud end of the run if it leads to a register that is not known, not clocked or not accessible that way.
 */
#ifndef BUS_H
#define BUS_H

#include <stdbool.h>
#include <stdint.h>

struct board;

struct block;

/* A write that has left the processor and acts when it arrives. */
struct bus_write {
    const struct block *block;
    uint32_t address;
    uint32_t value;
    uint32_t mask;
    uint32_t at; /* the instruction that wrote */
};

struct bus {
    uint32_t apb_wait;       /* cycles by which an access to an APB at a quarter of HCLK takes longer */
    uint64_t apb_busy_until; /* the write that is on its way has arrived */
    struct bus_write write;  /* there is one at most: the next access to APB waits for it */
};

/* Maps the peripherals into the processor's addresses. */
bool bus_init(struct board *board);

/* What is on its way is lost. */
void bus_reset(struct board *board);

/* When the last write has arrived at its peripheral; the arrival. */
uint64_t bus_idle_cycle(const struct board *board);
void bus_event(struct board *board, uint64_t cycle);

/* How many registers a peripheral has is known by its model: reads and writes answer false for one it does not have.
 * `mask` has ones where bits are written. */
typedef bool bus_reader(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
typedef bool bus_writer(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);

#endif
