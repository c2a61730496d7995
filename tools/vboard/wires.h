/*
 * Wires from a pin of the part to another one: what the one shows, whoever drives it, comes to the other from outside.
 * A pin has one such wire at most: a second one takes the place of the first.
 */
#ifndef WIRES_H
#define WIRES_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "gpio.h"

enum {
    WIRES_MAX = 8
};

struct wire {
    struct pin from; /* port GPIO_PORTS: none, the pin is let go */
    struct pin to;
    uint32_t late_ns; /* a rising edge comes so much later, a falling one at once: pulses get narrower */
    uint32_t loses;   /* every so many-th rising edge, with its falling one; 0: none */
    uint32_t rises;
    uint64_t due_ps; /* of the rising edge that is on its way; NEVER: none */
};

struct wires {
    struct clock *clock;
    struct gpio *gpio;
    unsigned count;
    struct wire wire[WIRES_MAX];
};

void wires_init(struct wires *wires, struct clock *clock, struct gpio *gpio);

/* Reads `PA0=PB6`, `none=PB6`, `PA0=PB6:late=500` (ns), `PA0=PB6:loses=5`. */
bool wires_read(const char *text, struct wire *wire);

/* False: there are too many. */
bool wires_connect(struct wires *wires, const struct wire *wire);

/* A pin has changed. */
void wires_note_edge(struct wires *wires, struct pin pin, bool level, uint64_t cycle);

#endif
