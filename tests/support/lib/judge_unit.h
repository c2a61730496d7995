/*
 * A whole unit on the host machine, under the judge.
 */
#ifndef JUDGE_UNIT_H
#define JUDGE_UNIT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "host_machine.h"
#include "judge.h"
#include "rkm04.h"

/* A bench has this first, so that the functions below can be given the bench. */
struct judged_unit {
    struct rkm04 *unit;
    struct judge *judge;
    struct host_machine *machine;
};

/* A machine at an epoch, selected, that tells the judge what happens. The unit is not switched on yet. */
void judge_unit_begin(struct judged_unit *judged, uint64_t epoch);

/* The machine's listeners, for a bench that has its own in front of them. The machine counts motors from 0 at the pins
 * and from 1 in the trace. */
void judge_unit_step(void *judged, uint64_t tick, unsigned motor, bool backward);
void judge_unit_connection(void *judged, uint64_t tick, unsigned motor, bool connected);
void judge_unit_direction(void *judged, uint64_t tick, unsigned motor, bool backward);
void judge_unit_trace(void *judged, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value);

/* A pass of main, for host_machine_run. */
uint64_t judge_unit_pass(void *judged);

/* Ends the run at a tick; writes each complaint as a line that begins with `mark`. Returns their number. */
uint32_t judge_unit_end(struct judged_unit *judged, uint64_t tick, FILE *file, const char *mark);

#endif
