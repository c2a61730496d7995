/*
 * A kind of unit, as `serve` needs it besides what every program does.
 */
#ifndef SERVE_KIND_H
#define SERVE_KIND_H

#include <stdbool.h>
#include <stdint.h>

#include "unit_kind.h"

struct serve_kind {
    const struct unit_kind *unit;
    const char *tool;       /* the name that complaints give to the command */
    const char *order_help; /* what is said to an order that is not understood */
    const char *flash_mark; /* four characters, by which files of the flash are told from those of other units */
    uint32_t byte_ticks;    /* from one byte on the line to the next; 0: the unit sets its rate and format */
    uint32_t silence_ticks; /* after bytes of clients, by which units tell one thing from the next; 0: by nothing */
    bool has_nodes;         /* units have addresses, and some may be on the same line */
};

#endif
