#include "timer_counter.h"

bool timer_is_wide(const struct timer *timer)
{
    return timer->wires.number == 0 || timer->wires.number == TIMER_TIM5; /* TIM2 and TIM5 have 32 bits */
}

uint32_t timer_width_mask(const struct timer *timer)
{
    return timer_is_wide(timer) ? UINT32_MAX : 0xFFFFU;
}

/* Section 18.4.12: the counter is blocked while the auto-reload value is null. */
bool timer_runs(const struct timer *timer)
{
    return (timer->cr1 & TIMER_CR1_CEN) != 0 && timer->arr_used != 0;
}

bool timer_is_captured(const struct timer *timer, unsigned channel)
{
    return (timer->ccmr[channel / 2U] >> 8U * (channel % 2U) & 3U) != 0;
}

uint32_t timer_clock_divider(const struct timer *timer)
{
    const struct conditions *conditions = timer->wires.conditions;
    return timer->wires.number == TIMER_TIM1 ? conditions->timer2_divider : conditions->timer1_divider;
}

uint64_t timer_tick_cycles(const struct timer *timer)
{
    return (uint64_t)timer_clock_divider(timer) * (timer->psc_used + 1U);
}

static uint64_t ticks_since_anchor(const struct timer *timer, uint64_t cycle)
{
    bool counts = timer_runs(timer) && cycle > timer->anchor_cycle;
    return counts ? (cycle - timer->anchor_cycle) / timer_tick_cycles(timer) : 0;
}

uint32_t timer_count_at(const struct timer *timer, uint64_t cycle)
{
    return (uint32_t)(timer->count + ticks_since_anchor(timer, cycle));
}

/* The last value before the counter turns to 0. A counter above ARR runs to the end of its width. */
static uint32_t last_count(const struct timer *timer)
{
    return timer->count > timer->arr_used ? timer_width_mask(timer) : timer->arr_used;
}

void timer_set_event(struct timer *timer)
{
    uint64_t due = timer->turn_due;
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        due = timer->channel[i].due < due ? timer->channel[i].due : due;
    }
    clock_set(timer->wires.clock, (enum event)(EVENT_TIM2 + timer->wires.number), due);
}

/* The counter must get to the value of a channel from below: one that it has already or has passed waits for the next
 * turn. With --match-equal, a value written while the counter stands on it matches at once. */
void timer_find_match(struct timer *timer, unsigned channel, uint64_t cycle)
{
    struct timer_channel *at = &timer->channel[channel];
    uint32_t now = timer_count_at(timer, cycle);
    at->due = VTIME_NEVER;
    if (!timer_runs(timer) || at->compare > last_count(timer) || timer_is_captured(timer, channel)) {
        return;
    }
    if (at->compare > now) {
        at->due = timer->anchor_cycle + (at->compare - timer->count) * timer_tick_cycles(timer);
    } else if (at->compare == now && timer->wires.settings->match_equal) {
        at->due = cycle + 1U;
    }
}

void timer_plan(struct timer *timer, uint64_t cycle)
{
    uint64_t ticks = (uint64_t)last_count(timer) - timer->count + 1U;
    timer->turn_due = timer_runs(timer) ? timer->anchor_cycle + ticks * timer_tick_cycles(timer) : VTIME_NEVER;
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        timer_find_match(timer, i, cycle);
    }
    timer_set_event(timer);
}

/* Moves the anchor to a cycle, and with it the ticks that have gone by; the part of a tick is kept. */
void timer_move_anchor(struct timer *timer, uint64_t cycle)
{
    uint64_t ticks = ticks_since_anchor(timer, cycle);
    timer->count += (uint32_t)ticks;
    timer->anchor_cycle = timer_runs(timer) ? timer->anchor_cycle + ticks * timer_tick_cycles(timer) : cycle;
}
