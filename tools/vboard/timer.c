#include "timer_private.h"

#include "board.h"

enum {
    SR_UIF = 1 << 0
};

static const enum nvic_irq irqs[TIMERS] = {NVIC_IRQ_TIM2, NVIC_IRQ_TIM3, NVIC_IRQ_TIM4, NVIC_IRQ_TIM5};

bool timer_is_wide(unsigned instance)
{
    return instance == 0 || instance == 3; /* TIM2 and TIM5 have 32 bits */
}

uint32_t timer_width_mask(unsigned instance)
{
    return timer_is_wide(instance) ? UINT32_MAX : 0xFFFFU;
}

/* Section 18.4.12: the counter is blocked while the auto-reload value is null. */
bool timer_runs(const struct timer *timer)
{
    return (timer->cr1 & TIMER_CR1_CEN) != 0 && timer->arr_used != 0;
}

uint64_t timer_tick_cycles(const struct board *board, unsigned instance)
{
    return (uint64_t)board->rcc.timer1_divider * (board->timer[instance].psc_used + 1U);
}

static uint64_t ticks_since_anchor(const struct board *board, unsigned instance, uint64_t cycle)
{
    const struct timer *timer = &board->timer[instance];
    bool counts = timer_runs(timer) && cycle > timer->anchor_cycle;
    return counts ? (cycle - timer->anchor_cycle) / timer_tick_cycles(board, instance) : 0;
}

uint32_t timer_count_at(const struct board *board, unsigned instance, uint64_t cycle)
{
    return (uint32_t)(board->timer[instance].count + ticks_since_anchor(board, instance, cycle));
}

/* The last value before the counter turns to 0. A counter above ARR runs to the end of its width. */
static uint32_t last_count(const struct timer *timer, unsigned instance)
{
    return timer->count > timer->arr_used ? timer_width_mask(instance) : timer->arr_used;
}

void timer_set_event(struct board *board, unsigned instance)
{
    const struct timer *timer = &board->timer[instance];
    uint64_t due = timer->turn_due;
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        due = timer->channel[i].due < due ? timer->channel[i].due : due;
    }
    events_set(board, (enum event)(EVENT_TIM2 + instance), due);
}

/* The counter must get to the value of a channel from below: one that it has already or has passed waits for the next
 * turn. With --match-equal, a value written while the counter stands on it matches at once. */
void timer_find_match(struct board *board, unsigned instance, unsigned channel, uint64_t cycle)
{
    struct timer *timer = &board->timer[instance];
    struct timer_channel *at = &timer->channel[channel];
    uint32_t now = timer_count_at(board, instance, cycle);
    at->due = VTIME_NEVER;
    if (!timer_runs(timer) || at->compare > last_count(timer, instance)) {
        return;
    }
    if (at->compare > now) {
        at->due = timer->anchor_cycle + (at->compare - timer->count) * timer_tick_cycles(board, instance);
    } else if (at->compare == now && board->options->match_equal) {
        at->due = cycle + 1U;
    }
}

void timer_plan(struct board *board, unsigned instance, uint64_t cycle)
{
    struct timer *timer = &board->timer[instance];
    uint64_t ticks = (uint64_t)last_count(timer, instance) - timer->count + 1U;
    timer->turn_due =
        timer_runs(timer) ? timer->anchor_cycle + ticks * timer_tick_cycles(board, instance) : VTIME_NEVER;
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        timer_find_match(board, instance, i, cycle);
    }
    timer_set_event(board, instance);
}

/* Moves the anchor to a cycle, and with it the ticks that have gone by; the part of a tick is kept. */
void timer_move_anchor(struct board *board, unsigned instance, uint64_t cycle)
{
    struct timer *timer = &board->timer[instance];
    uint64_t ticks = ticks_since_anchor(board, instance, cycle);
    timer->count += (uint32_t)ticks;
    timer->anchor_cycle = timer_runs(timer) ? timer->anchor_cycle + ticks * timer_tick_cycles(board, instance) : cycle;
}

void timer_update_interrupt(struct board *board, unsigned instance)
{
    const struct timer *timer = &board->timer[instance];
    nvic_set_line(board, irqs[instance], (timer->sr & timer->dier & TIMER_DIER_MODELLED) != 0);
}

void timer_match(struct board *board, unsigned instance, unsigned channel, uint64_t cycle)
{
    struct timer *timer = &board->timer[instance];
    timer->matches++;
    timer->sr |= 2U << channel;
    timer_match_output(board, instance, channel, cycle);
}

/* An update event (section 18.3.1): what was preloaded comes into force, and a timer of one pulse stops. */
void timer_update_event(struct board *board, unsigned instance, bool by_software)
{
    struct timer *timer = &board->timer[instance];
    if ((timer->cr1 & TIMER_CR1_UDIS) != 0) {
        return;
    }
    timer->psc_used = timer->psc;
    timer->arr_used = timer->arr;
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        timer->channel[i].compare = timer->channel[i].preload;
    }
    if (!by_software || (timer->cr1 & TIMER_CR1_URS) == 0) {
        timer->sr |= SR_UIF;
    }
    if ((timer->cr1 & TIMER_CR1_OPM) != 0) {
        timer->cr1 &= ~(uint32_t)TIMER_CR1_CEN;
    }
}

/* The counter turns to 0. Section 18.4.5: a channel whose value lies above ARR sets its flag now. */
static void turn(struct board *board, unsigned instance, uint64_t cycle)
{
    struct timer *timer = &board->timer[instance];
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        timer->sr |= timer->channel[i].compare > timer->arr_used ? 2U << i : 0U;
    }
    timer->count = 0;
    timer->anchor_cycle = cycle;
    timer_update_event(board, instance, false);
    timer_plan(board, instance, cycle);
    timer_update_outputs(board, instance, cycle);
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        if (timer->channel[i].compare == 0) {
            timer_match(board, instance, i, cycle);
        }
    }
}

static void timer_event(struct board *board, unsigned instance, uint64_t cycle)
{
    struct timer *timer = &board->timer[instance];
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        if (timer->channel[i].due <= cycle) {
            timer->channel[i].due = VTIME_NEVER;
            timer_match(board, instance, i, cycle);
        }
    }
    if (timer->turn_due <= cycle) {
        turn(board, instance, cycle);
    }
    timer_set_event(board, instance);
    timer_update_interrupt(board, instance);
}

void tim2_event(struct board *board, uint64_t cycle)
{
    timer_event(board, 0, cycle);
}

void tim3_event(struct board *board, uint64_t cycle)
{
    timer_event(board, 1, cycle);
}

void tim4_event(struct board *board, uint64_t cycle)
{
    timer_event(board, 2, cycle);
}

void tim5_event(struct board *board, uint64_t cycle)
{
    timer_event(board, 3, cycle);
}

void timers_hold(struct board *board)
{
    for (unsigned i = 0; i < TIMERS && board->rcc.timer1_divider != 0; i++) {
        timer_move_anchor(board, i, board->cpu.now);
    }
}

void timers_release(struct board *board)
{
    for (unsigned i = 0; i < TIMERS; i++) {
        timer_plan(board, i, board->cpu.now);
    }
}

void timer_reset(struct board *board, unsigned instance)
{
    struct timer *timer = &board->timer[instance];
    uint32_t all = timer_width_mask(instance);
    *timer = (struct timer){.arr = all, .arr_used = all, .start_cycle = VTIME_NEVER, .turn_due = VTIME_NEVER};
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        timer->channel[i].due = VTIME_NEVER;
        timer->channel[i].pin_driven = true; /* so that the pins are told */
        timer_update_output(board, instance, i, board->cpu.now);
    }
    timer_set_event(board, instance);
    timer_update_interrupt(board, instance);
}

void timers_reset(struct board *board)
{
    for (unsigned i = 0; i < TIMERS; i++) {
        timer_reset(board, i);
    }
}
