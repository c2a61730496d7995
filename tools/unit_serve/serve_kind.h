/*
 * A kind of unit, as `serve` needs it besides what every program does.
 */
#ifndef SERVE_KIND_H
#define SERVE_KIND_H

#include <stdbool.h>
#include <stdint.h>

#include "unit_kind.h"

/* What a line of a client asks of a unit. */
enum serve_asks {
    SERVE_ASKS_NOTHING, /* no answer */
    SERVE_ASKS_MORE,    /* no answer yet: it is part of a request that goes on */
    SERVE_ASKS,         /* one answer */
    SERVE_ASKS_APART,   /* one that is not told again */
    SERVE_ASKS_AGAIN,   /* the last one again */
    SERVE_ASKS_RESET,   /* one, and nothing of what waits before it has any */
};

struct serve_kind {
    const struct unit_kind *unit;
    const char *tool;       /* the name that complaints give to the command */
    const char *order_help; /* what is said to an order that is not understood */
    const char *flash_mark; /* four characters, by which files of the flash are told from those of other units */
    uint32_t byte_ticks;    /* from one byte on the line to the next; 0: the unit sets its rate and format */
    uint32_t silence_ticks; /* after bytes of clients, by which units tell one thing from the next; 0: by nothing */
    bool has_nodes;         /* units have addresses, and some may be on the same line */

    /* What a line without its CR asks, as part of a request that goes on or not; whether a unit owes an answer; and
     * whether the one that it sends is that to a reset. Null: nobody can tell whose an answer is, all clients hear
     * all. */
    enum serve_asks (*asks)(const uint8_t *line, uint32_t length, bool goes_on);
    bool (*owes)(const void *unit);
    bool (*answers_reset)(const void *unit);
};

#endif
