/*
 * The memory accelerator of the flash (RM0090 section 3.5.2), if --art asks for it: 64 lines of 128 bits for the
 * targets of branches and 8 for literals, the line used longest ago is replaced. Without it every taken branch into
 * flash and every literal costs the wait states.
 */
#ifndef ART_H
#define ART_H

#include <stdbool.h>
#include <stdint.h>

enum {
    ART_LINES = 64,
    ART_DATA_LINES = 8,
};

struct art {
    uint32_t tag[ART_LINES + ART_DATA_LINES];
    uint64_t used[ART_LINES + ART_DATA_LINES];
    uint64_t clock;
};

/* Whether the line of an instruction is there; it is from now on. */
bool art_fetch(struct art *art, uint32_t address);

/* Whether it is there; nothing changes. */
bool art_has(const struct art *art, uint32_t address);

/* Whether the literal of the instruction at an address is there; it is from now on. */
bool art_fetch_literal(struct art *art, uint32_t address);

void art_reset(struct art *art);

#endif
