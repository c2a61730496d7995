/*
 * A simulation: the unit on a machine of its own, watched. It is large (300 kB and more): on the heap.
 */
#ifndef RUN_H
#define RUN_H

#include <stdbool.h>
#include <stdint.h>

#include "host_machine.h"
#include "recorder.h"
#include "tally.h"
#include "rkm04.h"

struct run {
    struct host_machine machine;
    struct rkm04 unit;
    struct recorder recorder;
    struct tally tally[UNIT_MOTORS];
    int64_t positions[UNIT_MOTORS]; /* as recorded last */
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

/* A unit that has just been switched on, with no output files; it stays the one that the hal functions work on. */
void run_begin(struct run *run, uint64_t epoch);

/* Lets the unit run until all motors are idle or for so many ticks from the start. */
void run_until(struct run *run, uint64_t until_tick);

#endif
