/*
 * General-purpose timers TIM2 to TIM5 (RM0090 chapter 18), counting up, with four output-compare channels each. Edges
 * come at the exact tick of the counter, whatever the processor does.
 */
#ifndef TIMER_H
#define TIMER_H

#include "timer_counter.h"

void timer_init(struct timer *timer, struct timer_wires wires);
void timer_reset(struct timer *timer);

/* Around a change of the clocks. */
void timer_hold(struct timer *timer);
void timer_release(struct timer *timer);

/* For timer_registers.c. An update event (RM0090 section 18.3.1): what was preloaded comes into force. */
void timer_update_event(struct timer *timer, bool by_software, uint64_t cycle);

/* A compare event of a channel asks for a transfer if that is enabled (section 18.4.4). */
void timer_request_channel(struct timer *timer, unsigned channel, uint64_t cycle);
void timer_update_interrupt(struct timer *timer);

#endif
