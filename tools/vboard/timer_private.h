/*
 * Between the two halves of the timers: timer.c counts, timer_registers.c is what the program sees.
 */
#ifndef TIMER_PRIVATE_H
#define TIMER_PRIVATE_H

#include "timer.h"

enum {
    TIMER_CR1_CEN = 1 << 0,
    TIMER_CR1_UDIS = 1 << 1,
    TIMER_CR1_URS = 1 << 2,
    TIMER_CR1_OPM = 1 << 3,
    TIMER_CR1_ARPE = 1 << 7,
    TIMER_DIER_MODELLED = 0x1F,
};

/* TIM2 and TIM5 have 32 bits, the others 16. */
bool timer_is_wide(unsigned instance);
uint32_t timer_width_mask(unsigned instance);

bool timer_runs(const struct timer *timer);
uint32_t timer_count_at(const struct board *board, unsigned instance, uint64_t cycle);

/* Moves the anchor to a cycle, and with it the ticks that have gone by; the part of a tick is kept. */
void timer_move_anchor(struct board *board, unsigned instance, uint64_t cycle);

/* Finds anew when the counter turns over and when each channel matches; then find_match and set_event do it for one. */
void timer_plan(struct board *board, unsigned instance, uint64_t cycle);
void timer_find_match(struct board *board, unsigned instance, unsigned channel, uint64_t cycle);
void timer_set_event(struct board *board, unsigned instance);

/* An update event (RM0090 section 18.3.1): what was preloaded comes into force. */
void timer_update_event(struct board *board, unsigned instance, bool by_software);

/* A match of a channel: flag and output. */
void timer_match(struct board *board, unsigned instance, unsigned channel, uint64_t cycle);

void timer_update_interrupt(struct board *board, unsigned instance);

#endif
