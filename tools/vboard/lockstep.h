/*
 * A client on the line in virtual time. Its orders come on standard input, a line each:
 *
 *   say HEXBYTES   onto the line, back to back, as soon as that is free
 *   until MS       time goes on until then, or until the unit has sent a byte; the reply on standard output is the
 *                  time, in ms, and the bytes that have come, if any
 *   wire PIN=PIN   a wire, as --wire has it; none=PIN: it is taken off
 *   end            the run ends; so it does with the end of the input
 *
 * While an order is waited for no virtual time passes, so runs repeat whatever else the computer does.
 */
#ifndef LOCKSTEP_H
#define LOCKSTEP_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "report.h"
#include "rs485.h"
#include "wires.h"

enum {
    LOCKSTEP_HEARD_MAX = 16,
    LOCKSTEP_ORDER_MAX = 65536
};

struct lockstep {
    struct clock *clock;
    struct rs485 *line;
    struct wires *wires;
    struct report *report;
    bool asked; /* an `until` has no reply yet */
    unsigned heard;
    uint8_t byte[LOCKSTEP_HEARD_MAX]; /* of these */
    char order[LOCKSTEP_ORDER_MAX];
};

void lockstep_init(struct lockstep *lockstep, struct clock *clock, struct rs485 *line, struct wires *wires,
                   struct report *report);

/* From now on it is the client that says when. */
void lockstep_open(struct lockstep *lockstep);

/* A byte that the unit has sent, for a struct lockstep. */
void lockstep_hear(void *model, uint8_t value);

#endif
