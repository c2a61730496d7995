/*
 * General-purpose timers TIM2 to TIM5 (RM0090 chapter 18), counting up, with four output-compare channels each. Edges
 * come at the exact tick of the counter, whatever the processor does.
 */
#ifndef TIMER_H
#define TIMER_H

#include <stdbool.h>
#include <stdint.h>

struct board;

enum {
    TIMERS = 4,
    TIMER_CHANNELS = 4,
};

struct timer_channel {
    uint32_t compare; /* what the counter is compared with */
    uint32_t preload; /* what CCR reads */
    uint64_t due;     /* cycle of the next match; NEVER: none before the counter turns over */
    uint8_t mode;     /* OCxM, as it was when the output was looked at last */
    bool below;       /* and whether the counter was below the value */
    bool reference;   /* OCxREF */
    bool pin_level;   /* what the pins were told last */
    bool pin_driven;
};

struct timer {
    uint32_t cr1;
    uint32_t cr2;
    uint32_t dier;
    uint32_t sr;
    uint32_t ccmr[2];
    uint32_t ccer;
    uint32_t psc; /* as written; comes into force with an update */
    uint32_t psc_used;
    uint32_t arr; /* as written */
    uint32_t arr_used;
    uint32_t remap; /* OR */
    uint32_t count; /* at the anchor */
    uint64_t anchor_cycle;
    uint64_t start_cycle; /* the first time it was started since reset; NEVER: not yet */
    uint64_t turn_due;    /* cycle of the turn-over */
    struct timer_channel channel[TIMER_CHANNELS];
    uint64_t matches;
};

void timers_reset(struct board *board);
void timer_reset(struct board *board, unsigned instance);

bool timer_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
bool timer_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);

/* Whether a register has 32 bits that mean something. */
bool timer_register_is_wide(unsigned instance, uint32_t offset);

/* Around a change of the clocks. */
void timers_hold(struct board *board);
void timers_release(struct board *board);

void tim2_event(struct board *board, uint64_t cycle);
void tim3_event(struct board *board, uint64_t cycle);
void tim4_event(struct board *board, uint64_t cycle);
void tim5_event(struct board *board, uint64_t cycle);

/* Cycles of HCLK in one tick of a timer. */
uint64_t timer_tick_cycles(const struct board *board, unsigned instance);

/* For timer_output.c: the outputs follow what the registers say. */
void timer_update_output(struct board *board, unsigned instance, unsigned channel, uint64_t cycle);
void timer_update_outputs(struct board *board, unsigned instance, uint64_t cycle);
void timer_match_output(struct board *board, unsigned instance, unsigned channel, uint64_t cycle);
unsigned timer_output_mode(const struct timer *timer, unsigned channel);

#endif
