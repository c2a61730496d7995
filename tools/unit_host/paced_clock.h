/*
 * The time of a unit that follows a real clock by itself, for who calls now and then, as the worker of a page.
 * Real time is the caller's, in ns from any moment, and does not go back.
 */
#ifndef PACED_CLOCK_H
#define PACED_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "host_machine.h"
#include "serve_clock.h"

struct paced_clock {
    struct serve_clock clock;
    uint64_t stood_ticks; /* the real time, of all so far, in which the unit's time stood */
};

/* The machine is at its first tick. */
void paced_clock_begin(struct paced_clock *paced, uint64_t real_ns);

/* Lets the machine run as far as the clock has come, a slice at most. True: it is behind yet, call again. If it is more
 * than SERVE_LAG_MS_MAX behind, nobody has called for so long: its time has stood, and goes on from where it is. */
bool paced_clock_follow(struct paced_clock *paced, struct host_machine *machine, uint64_t real_ns,
                        uint64_t (*poll)(void *unit), void *unit);

#endif
