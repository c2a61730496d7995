/*
 * A simulation: a unit on a machine of its own, watched. It is large (280 kB and more), as units are: on the heap.
 */
#ifndef RUN_H
#define RUN_H

#include <stdbool.h>
#include <stdint.h>

#include "host_machine.h"
#include "recorder.h"
#include "tally.h"
#include "unit_kind.h"

/* Who takes part in a simulation. Entries may be null. */
struct run_partner {
    void *context;
    void (*line)(void *context, uint64_t tick, uint8_t value); /* hears what the unit sends */
    uint64_t (*pass)(
        void *context); /* after each pass of main; the tick, from the start, of the next one at the latest */
    bool (*is_over)(const void *context); /* whether the simulation may end where the unit is idle */
};

struct run {
    struct host_machine machine;
    const struct unit_kind *kind;
    void *unit;
    struct run_partner partner;
    struct recorder recorder;
    struct tally tally[UNIT_MOTORS];
    int64_t positions[UNIT_MOTORS]; /* after the last pulse, or the last pass of main */
    uint64_t begin_ns;              /* real time of the beginning, as units_real_ns */
    uint64_t progress_ns;           /* of real time, from telling the progress to telling it again; 0: never */
    uint64_t told_ns;               /* real time at which it was told last */
    uint32_t steps;                 /* counted while the progress is to be told */
    uint64_t limit_ns;              /* of real time; 0: none */
    uint32_t passes;                /* of the main loop, modulo 2^32 */
    uint64_t real_ns;               /* time that the simulation took */
    bool idle;                      /* ended because nothing more could happen */
    bool cut;                       /* ended because the real time was over */
};

/* A machine for a unit that is off, with no output files and no partner; it stays the one that the hal functions work
 * on. The unit, `kind->bytes` large, is the caller's. */
void run_init(struct run *run, const struct unit_kind *kind, void *unit, uint64_t epoch);

/* Switches the unit on. */
void run_begin(struct run *run);

/* Lets the unit run until it is idle and its partner has nothing left to do, or for so many ticks from the start. */
void run_until(struct run *run, uint64_t until_tick);

/* What ended it: the unit, the limit of real time, or that of unit time: idle, real, time. */
const char *run_end_text(const struct run *run);

/* Unit time to real time, in thousandths. */
uint64_t run_milli_ratio(const struct run *run);

#endif
