/*
 * How instructions and literals come from the flash: line by line with its wait states, the next line prefetched, and
 * with --art from the accelerator.
 */
#ifndef FETCH_H
#define FETCH_H

#include <stdbool.h>
#include <stdint.h>

#include "art.h"
#include "clock.h"
#include "flash.h"

struct fetch {
    struct clock *clock;
    const struct flash *flash;
    bool art_modelled;
    bool shared_bus;
    uint32_t line_mask; /* of the line of the flash that is executed; 0 outside the flash */
    uint32_t line;
    uint64_t line_cycle; /* when it was there */
    struct art art;
};

/* The extra cycles of a fetch from a place that is not the next instruction, where the program goes on. */
uint32_t fetch_jump(struct fetch *fetch, uint32_t address);

/* The program runs into the next line of the flash and waits for it. */
void fetch_enter_line(struct fetch *fetch, uint32_t address);

/* The wait states of a literal read by the instruction at an address. */
uint32_t fetch_literal_wait(struct fetch *fetch, uint32_t address);

static inline bool fetch_is_same_line(const struct fetch *fetch, uint32_t address)
{
    return (address & fetch->line_mask) == fetch->line;
}

#endif
