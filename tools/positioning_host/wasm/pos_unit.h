/*
 * The virtual positioning unit of a page: what the WebAssembly module positioning-unit exports beside paced_line.h.
 */
#ifndef POS_UNIT_H
#define POS_UNIT_H

#include <stdint.h>

#include "paced_line.h"

/* A unit after power-on, of address 1. Bytes take no time on its line, but the silence after a frame does. Null: there
 * is not memory enough. */
struct paced_line *pos_unit_begin(uint64_t real_ns);

#endif
