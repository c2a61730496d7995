/*
 * The memory accelerator of the flash (RM0090 section 3.5.2), if --art asks for it: 64 lines of 128 bits for the
 * targets of branches and 8 for literals, the line used longest ago is replaced. Without it every taken branch into
 * flash and every literal costs the wait states.
 */
#ifndef ART_H
#define ART_H

#include <stdbool.h>
#include <stdint.h>

#include "cpu.h"

/* Whether the line of an instruction is there; it is from now on. */
bool art_fetch(struct art *art, uint32_t address);

/* Whether it is there; nothing changes. */
bool art_has(const struct art *art, uint32_t address);

/* The wait states of a literal read by the instruction at an address. */
uint32_t art_literal_wait(struct board *board, uint32_t address);

void art_reset(struct art *art);

#endif
