/*
 * The lines by which timers and USART1 ask the DMA controllers for transfers (RM0090 sections 10.3.2, 18.4.4 and
 * 30.3.13). A line that was raised stays high until the controller acknowledges it or who has raised it takes it back;
 * an event of a timer meanwhile is lost.
 */
#ifndef REQUESTS_H
#define REQUESTS_H

#include <stdint.h>

/* Of each timer, TIM2 to TIM5, in this order. */
enum request_source {
    REQUEST_UPDATE,
    REQUEST_CHANNEL_1,
    REQUEST_CHANNEL_2,
    REQUEST_CHANNEL_3,
    REQUEST_CHANNEL_4,
    REQUEST_SOURCES,
};

enum {
    REQUEST_TIMERS = 4,
    REQUEST_USART1_RX = REQUEST_TIMERS * REQUEST_SOURCES,
    REQUEST_LINES,
    REQUEST_LISTENERS = 2,
};

/* Who is told that a line has gone high; null: nobody. */
struct request_listener {
    void *model;
    void (*note)(void *model, uint64_t cycle);
};

struct requests {
    struct request_listener listener[REQUEST_LISTENERS]; /* the controllers */
    uint32_t high;                                       /* a bit a line */
    uint64_t since[REQUEST_LINES];                       /* cycle */
    uint64_t lost;                                       /* events that found their line high */
};

/* `timer` is 0 for TIM2. */
static inline uint32_t request_line(unsigned timer, unsigned source)
{
    return UINT32_C(1) << (timer * REQUEST_SOURCES + source);
}

void requests_raise(struct requests *requests, unsigned timer, unsigned source, uint64_t cycle);

/* The line by which USART1 asks for what it has received to be fetched. */
void requests_raise_receiver(struct requests *requests, uint64_t cycle);

/* Lines, a bit each, go low: they were acknowledged, or are taken back. */
void requests_lower(struct requests *requests, uint32_t lines);

/* The first cycle from which on one of these lines, of which one at least is high, has been so. */
uint64_t requests_since(const struct requests *requests, uint32_t lines);

#endif
