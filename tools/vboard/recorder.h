/*
 * What happens at the pins: pulses counted and checked, and written to the steps table and the waveform file.
 */
#ifndef RECORDER_H
#define RECORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "outfile.h"
#include "pins.h"
#include "report.h"
#include "rs485.h"
#include "timer.h"
#include "waves.h"

/* One motor. Times are cycles; they are compared only while the clock stays as it is. */
struct recorder_motor {
    int64_t position;
    uint64_t pulses;
    uint64_t rise_cycle; /* of the last pulse */
    uint64_t fall_cycle;
    uint64_t turn_cycle;     /* of the last change of DIR */
    uint64_t width_least_ps; /* NEVER: none yet */
    uint64_t gap_least_ps;   /* from the end of a pulse to the next one */
    uint64_t period_least_ps;
    uint64_t setup_least_ps; /* from a change of DIR to the next pulse */
    uint64_t hold_least_ps;  /* from a pulse to the next change of DIR */
    bool direction_fresh;    /* it has changed since the last pulse */
};

struct recorder_wires {
    const struct clock *clock;
    struct report *report;
    const struct pins *pins;
    const struct timer *timer; /* whose ticks are those of the table */
    struct rs485 *line;
    bool ticks_from_timer; /* the ticks count from its start, else from power-on */
};

struct recorder {
    struct recorder_wires wires;
    bool level[SIGNALS]; /* logical */
    uint64_t edge_cycle[SIGNALS];
    struct recorder_motor motor[PINS_MOTORS];
    struct outfile steps;
    struct waves waves;
    uint64_t tick_hz;       /* that the table says; 0: it has not been begun */
    uint64_t first_step_ps; /* NEVER: none yet */
};

/* Opens the files, null for none. False after a complaint. */
bool recorder_open(struct recorder *recorder, const char *steps, const char *vcd);

/* A pin has a new level, which is told to a struct recorder. */
void recorder_note_edge(void *model, struct pin pin, bool level, uint64_t cycle);

/* Which of `count` signals are active, one bit each. */
unsigned recorder_active(const struct recorder *recorder, unsigned signal, unsigned count);

/* Ends the files. False after a complaint. */
bool recorder_close(struct recorder *recorder);

/* Lets go of the files; those that were not ended vanish. */
void recorder_discard(struct recorder *recorder);

/* The tick of the timer in 64 bits at a cycle. */
uint64_t recorder_tick(const struct recorder *recorder, uint64_t cycle);

#endif
