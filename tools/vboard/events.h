/*
 * What is going to happen on the board, one entry a source. An event runs with the cycle at which it is due, however
 * late the processor gets to a boundary between instructions.
 */
#ifndef EVENTS_H
#define EVENTS_H

#include <stdint.h>

struct board;

enum event {
    EVENT_TIM2,
    EVENT_TIM3,
    EVENT_TIM4,
    EVENT_TIM5,
    EVENT_SYSTICK,
    EVENT_USART1,
    EVENT_USART2,
    EVENT_USART3,
    EVENT_BUS,
    EVENT_FLASH,
    EVENT_RCC,
    EVENT_CRYSTAL,
    EVENT_IWDG,
    EVENT_LINE,
    EVENT_INPUTS,
    EVENT_FAULT,
    EVENT_SUPPLY,
    EVENT_THROTTLE,
    EVENT_MEASURE,
    EVENT_END,
    EVENTS,
};

struct events {
    uint64_t due[EVENTS];    /* cycle; VTIME_NEVER: not set */
    uint64_t due_ps[EVENTS]; /* of events that are set by time, so that they stay when the clock changes; else NEVER */
    uint64_t next;           /* the earliest of `due` */
};

void events_init(struct events *events);

/* Sets or, with VTIME_NEVER, takes back an event. A cycle that has gone by is due at once. */
void events_set(struct board *board, enum event event, uint64_t cycle);
void events_set_ps(struct board *board, enum event event, uint64_t ps);

/* Runs all that is due up to and including `cycle`, in order. */
void events_run(struct board *board, uint64_t cycle);

/* Puts the events that were set by time on their new cycles after the clock has changed. */
void events_rescale(struct board *board);

#endif
