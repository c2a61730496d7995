/*
 * The inputs file: lines `ms,input,level`, as 350.5,3,1: input 3 becomes 1 at 350.5 ms. Milliseconds have up to 6
 * decimals and become the nearest tick; `#` starts a comment; blank lines are skipped; lines may come in any order.
 * Levels are those that the kind of unit shows.
 */
#ifndef INPUTS_H
#define INPUTS_H

#include <stdbool.h>
#include <stdint.h>

#include "host_machine.h"
#include "unit_kind.h"

struct inputs {
    struct host_input *script; /* sorted by tick, of the same tick as in the file */
    uint32_t length;
};

/* Reads the file for units of a kind; a null path gives an empty script. False after a complaint. */
bool inputs_read(struct inputs *inputs, const char *path, const struct unit_kind *kind);

void inputs_discard(struct inputs *inputs);

#endif
