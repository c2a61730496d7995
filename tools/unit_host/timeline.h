/*
 * Events in order of time, for files that are written in one pass.
 *
 * Main tells of some events a little after they happened (the end of a move is seen in the main loop), and some are
 * known ahead (the falling edge of STEP). The timeline holds every event back for TIMELINE_WINDOW_TICKS and then
 * delivers: sorted by tick, of the same tick in the order in which they came. Memory: the struct; when it is full, the
 * earliest event is delivered before its time.
 */
#ifndef TIMELINE_H
#define TIMELINE_H

#include <stdint.h>

#include "base_tick.h"

enum {
    TIMELINE_EVENTS_MAX = 4096
};

/* No event is told later than this, as long as the main loop is called every 20 us: 2 ms. */
#define TIMELINE_WINDOW_TICKS (UINT64_C(2) * TICKS_PER_MS)

enum timeline_kind {
    TIMELINE_STEP,      /* rising edge of STEP; value = position after it */
    TIMELINE_STEP_END,  /* its falling edge */
    TIMELINE_POSITION,  /* the position was set; value = position */
    TIMELINE_DIRECTION, /* value = 1: backward */
    TIMELINE_POLARITY,  /* detail = 1: the active edge of STEP falls; value = 1: DIR is turned */
    TIMELINE_LED,       /* motor = its number, from 1; value = 1: on */
    TIMELINE_PWM,       /* value = per mille */
    TIMELINE_INPUT,     /* value = levels of all inputs, bit 0 is BI1 */
    TIMELINE_OUTPUT,    /* value = levels of all outputs */
    TIMELINE_TRACE,     /* detail = enum hal_trace_event, value as there */
};

struct timeline_event {
    uint64_t tick;
    int64_t value;
    uint64_t interval_ticks; /* of a step: as tally_count_pulse tells it; else 0 */
    uint8_t kind;            /* enum timeline_kind */
    uint8_t motor;           /* 1 to 4; 0: the unit; of an LED 1 to 8 */
    uint8_t detail;          /* see above, else 0 */
};

typedef void timeline_deliver(void *context, const struct timeline_event *event);

struct timeline {
    struct timeline_event ring[TIMELINE_EVENTS_MAX];
    uint32_t head; /* count of events put in, modulo 2^32 */
    uint32_t tail; /* count of events delivered */
    timeline_deliver *deliver;
    void *context;
};

void timeline_init(struct timeline *timeline, timeline_deliver *deliver, void *context);

/* Takes an event and delivers what is old enough at `now_ticks`. */
void timeline_put(struct timeline *timeline, const struct timeline_event *event, uint64_t now_ticks);

/* Delivers what is left. */
void timeline_flush(struct timeline *timeline);

#endif
