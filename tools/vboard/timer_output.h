/*
 * From a match of a timer's channel to the level of its pins (RM0090 sections 18.3.8 to 18.3.10 and 18.4.7).
 */
#ifndef TIMER_OUTPUT_H
#define TIMER_OUTPUT_H

#include "timer_counter.h"

/* The outputs follow what the registers say. */
void timer_update_output(struct timer *timer, unsigned channel, uint64_t cycle);
void timer_update_outputs(struct timer *timer, uint64_t cycle);

/* And what a match does. */
void timer_match_output(struct timer *timer, unsigned channel, uint64_t cycle);

#endif
