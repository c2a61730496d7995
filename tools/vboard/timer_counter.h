/*
 * The counter of a timer (RM0090 section 18.3): what it shows at a cycle, when it turns over, and when it gets to the
 * values of its channels.
 */
#ifndef TIMER_COUNTER_H
#define TIMER_COUNTER_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "conditions.h"
#include "gpio.h"
#include "nvic.h"
#include "rcc.h"
#include "report.h"
#include "requests.h"

enum {
    TIMER_TIM5 = 3,
    TIMER_TIM1 = 4, /* on APB2; only its counter and its inputs are modelled */
    TIMERS_ON_APB1 = 4,
    TIMERS,
    TIMER_CHANNELS = 4,
};

struct timer_channel {
    uint32_t compare; /* what the counter is compared with */
    uint32_t preload; /* what CCR reads; of an input, what was captured */
    unsigned edges;   /* of an input, since the last capture */
    uint64_t due;     /* cycle of the next match; NEVER: none before the counter turns over */
    uint8_t mode;     /* OCxM, as it was when the output was looked at last */
    bool below;       /* and whether the counter was below the value */
    bool reference;   /* OCxREF */
    bool pin_level;   /* what the pins were told last */
    bool pin_driven;
};

struct timer_settings {
    unsigned steps;     /* the timer that makes the steps: 0 is TIM2 */
    uint64_t start;     /* the count at which it starts */
    bool match_equal;   /* a compare value written while the counter stands on it matches */
    bool pwm_at_once;   /* a channel that comes from a forced level shows the comparison at once */
    bool requests_stay; /* a request that was not served outlasts its enable in DIER */
};

struct timer_wires {
    unsigned number; /* 0: TIM2, up to TIM5; then TIM1 */
    struct clock *clock;
    struct report *report;
    struct nvic *nvic;
    const struct conditions *conditions;
    struct gpio *gpio;
    struct requests *requests; /* to the DMA controller */
    const struct timer_settings *settings;
    const struct rcc *rcc; /* whose low-speed oscillator can be captured, and its rate */
    uint64_t lsi_hz;
};

struct timer {
    struct timer_wires wires;
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
    bool hears_lsi; /* edges of the low-speed oscillator come in; the next one rises */
    bool lsi_level;
    uint32_t count; /* at the anchor */
    uint64_t anchor_cycle;
    uint64_t start_cycle; /* the first time it was started since reset; NEVER: not yet */
    uint64_t turn_due;    /* cycle of the turn-over */
    struct timer_channel channel[TIMER_CHANNELS];
    uint64_t matches;
};

enum {
    TIMER_CR1_CEN = 1 << 0,
    TIMER_CR1_UDIS = 1 << 1,
    TIMER_CR1_URS = 1 << 2,
    TIMER_CR1_OPM = 1 << 3,
    TIMER_CR1_ARPE = 1 << 7,
    TIMER_CR2_CCDS = 1 << 3,
    TIMER_DIER_INTERRUPTS = 0x1F,
    TIMER_DIER_REQUESTS = 0x1F00, /* UDE, CC1DE to CC4DE: enum request_source */
    TIMER_DIER_REQUESTS_SHIFT = 8,
};

/* TIM2 and TIM5 have 32 bits, the others 16. */
bool timer_is_wide(const struct timer *timer);
uint32_t timer_width_mask(const struct timer *timer);

bool timer_runs(const struct timer *timer);

/* Whether a channel is an input (CCxS, section 18.4.7). */
bool timer_is_captured(const struct timer *timer, unsigned channel);

/* Cycles of HCLK in one of the clock that the timer is given; 0: none yet. */
uint32_t timer_clock_divider(const struct timer *timer);

/* Cycles of HCLK in one tick. */
uint64_t timer_tick_cycles(const struct timer *timer);

uint32_t timer_count_at(const struct timer *timer, uint64_t cycle);

/* Moves the anchor to a cycle, and with it the ticks that have gone by; the part of a tick is kept. */
void timer_move_anchor(struct timer *timer, uint64_t cycle);

/* Finds anew when the counter turns over and when each channel matches; then find_match and set_event do it for one. */
void timer_plan(struct timer *timer, uint64_t cycle);
void timer_find_match(struct timer *timer, unsigned channel, uint64_t cycle);
void timer_set_event(struct timer *timer);

#endif
