/*
 * All units of `serve`, which are always at the same tick.
 */
#ifndef SERVE_UNITS_H
#define SERVE_UNITS_H

#include <stdbool.h>
#include <stdint.h>

#include "complain.h"
#include "serve_line.h"
#include "serve_options.h"
#include "serve_order.h"
#include "serve_unit.h"

struct serve_units {
    const struct serve_kind *kind;
    struct serve_unit *list[SERVE_UNITS_MAX];
    unsigned count;
    uint64_t now; /* ticks */
};

/* The units that the options ask for, on a line. EXIT_DONE, or after a complaint what else. In both cases to be
 * discarded. */
enum exit_status serve_units_begin(struct serve_units *units, const struct serve_kind *kind,
                                   const struct serve_options *options, struct serve_line *line);

/* Lets all of them run up to a tick; one that is past changes nothing. */
void serve_units_run(struct serve_units *units, uint64_t until_tick);

/* The tick of what happens next; TICK_NEVER: nothing. */
uint64_t serve_units_next_tick(const struct serve_units *units);

bool serve_units_have_work(const struct serve_units *units);

/* Whether something is on the line, or is still to be answered; of a kind that tells it. */
bool serve_units_owe(const struct serve_units *units);

/* Tells them that the line has heard more. */
void serve_units_hear(struct serve_units *units, const struct serve_line *line);

/* Sets an input. Null, or what is wrong with the order. */
const char *serve_units_set_input(struct serve_units *units, const struct serve_order *order);

/* Writes what has changed in the flash to the files. */
void serve_units_save(struct serve_units *units);

/* The same at the end. False after a complaint. */
bool serve_units_save_rest(struct serve_units *units);

void serve_units_discard(struct serve_units *units);

#endif
