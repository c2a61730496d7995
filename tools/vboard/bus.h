/*
 * The buses to the peripherals: which block an address belongs to, whether its clock runs, how long an access takes,
 * and a loud end of the run if it leads to a register that is not known, not clocked or not accessible that way.
 */
#ifndef BUS_H
#define BUS_H

#include <stdbool.h>
#include <stdint.h>

struct board;

struct bus {
    uint32_t apb_wait;         /* cycles by which an access to APB1 or APB2 takes longer */
    uint64_t apb_busy_until;   /* the write that is on its way has arrived */
};

/* Maps the peripherals into the processor's addresses. */
bool bus_init(struct board *board);

/* When the last write has arrived at its peripheral. */
uint64_t bus_idle_cycle(const struct board *board);

/* How many registers a peripheral has is known by its model: reads and writes answer false for one it does not have.
 * `mask` has ones where bits are written. */
typedef bool bus_reader(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
typedef bool bus_writer(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);

#endif
