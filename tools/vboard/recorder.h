/*
 * What happens at the pins: pulses counted and checked, and written to the steps table and the waveform file.
 */
#ifndef RECORDER_H
#define RECORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "outfile.h"
#include "pins.h"
#include "vcd.h"

struct board;

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

struct recorder {
    bool level[SIGNALS]; /* logical */
    uint64_t edge_cycle[SIGNALS];
    struct recorder_motor motor[PINS_MOTORS];
    struct outfile steps;
    struct vcd vcd;
    uint64_t tick_hz;       /* that the table says; 0: it has not been begun */
    uint64_t first_step_ps; /* NEVER: none yet */
};

/* Opens the files that the options ask for. False after a complaint. */
bool recorder_open(struct board *board);

/* A pin has a new level. */
void recorder_note_edge(struct board *board, struct pin pin, bool level, uint64_t cycle);

/* Ends the files. False after a complaint. */
/* Which of `count` signals are active, one bit each. */
unsigned recorder_active(const struct board *board, unsigned signal, unsigned count);

bool recorder_close(struct board *board);

/* Lets go of the files; those that were not ended vanish. */
void recorder_discard(struct board *board);

/* The tick of TIM2 in 64 bits at a cycle: counted from power-on, or with --ticks timer from its start. */
uint64_t recorder_tick(const struct board *board, uint64_t cycle);

#endif
