/*
 * The clock of the board: the cycle that it has got to, the time of day of a cycle, and what is going to happen, one
 * entry a source. An event runs with the cycle at which it is due, however late the processor gets to a boundary
 * between instructions.
 */
#ifndef CLOCK_H
#define CLOCK_H

#include <stdint.h>

#include "vtime.h"

/* Events of the same cycle run in this order. */
enum event {
    EVENT_TIM2,
    EVENT_TIM3,
    EVENT_TIM4,
    EVENT_TIM5,
    EVENT_TIM1,
    EVENT_SYSTICK,
    EVENT_USART1,
    EVENT_USART2,
    EVENT_USART3,
    EVENT_DMA1, /* after the timers, so that all that ask at once are heard */
    EVENT_DMA2,
    EVENT_BUS,
    EVENT_FLASH,
    EVENT_RCC,
    EVENT_CRYSTAL,
    EVENT_IWDG,
    EVENT_LSI,
    EVENT_LINE,
    EVENT_INPUTS,
    EVENT_WIRES,
    EVENT_FAULT,
    EVENT_SUPPLY,
    EVENT_THROTTLE,
    EVENT_MEASURE,
    EVENT_END,
    EVENTS,
};

/* What a source does at an event; `cycle` is the one at which it was due. */
typedef void clock_handler(void *model, uint64_t cycle);

struct clock_source {
    clock_handler *handler;
    void *model;
    uint64_t due;    /* cycle; VTIME_NEVER: not set */
    uint64_t due_ps; /* of events that are set by time, so that they stay when the rate changes; else NEVER */
};

struct clock {
    uint64_t now;      /* cycles; inside an instruction: at its end */
    uint64_t deadline; /* from this cycle on the next boundary is looked at; 0: at once */
    uint64_t next;     /* the earliest event */
    uint64_t moment;   /* cycle of the event that runs, or of the last access to a peripheral */
    uint64_t asleep_cycles;
    uint64_t stalled_cycles; /* waiting for the flash */
    struct vtime time;
    struct clock_source source[EVENTS];
};

/* At cycle 0, with a rate that holds until the first reset. */
void clock_init(struct clock *clock, uint64_t hz);

/* Says who is called for an event. */
void clock_attach(struct clock *clock, enum event event, clock_handler *handler, void *model);

/* Sets or, with VTIME_NEVER, takes back an event. A cycle that has gone by is due at once. */
void clock_set(struct clock *clock, enum event event, uint64_t cycle);
void clock_set_ps(struct clock *clock, enum event event, uint64_t ps);

/* Runs all that is due up to and including `cycle`, in order. */
void clock_run(struct clock *clock, uint64_t cycle);

/* Another rate from now on. Events that were set by time move to their new cycles. */
void clock_set_hclk(struct clock *clock, uint64_t hz);

uint64_t clock_now_ps(const struct clock *clock);
uint64_t clock_ps_of_cycle(const struct clock *clock, uint64_t cycle);

/* Something has changed that the next boundary must look at. */
static inline void clock_poke(struct clock *clock)
{
    clock->deadline = 0;
}

#endif
