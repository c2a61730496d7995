#include "timer.h"

#include "timer_output.h"

enum {
    SR_UIF = 1 << 0
};

static const enum nvic_irq irqs[TIMERS_ON_APB1] = {NVIC_IRQ_TIM2, NVIC_IRQ_TIM3, NVIC_IRQ_TIM4, NVIC_IRQ_TIM5};

void timer_update_interrupt(struct timer *timer)
{
    if (timer->wires.number == TIMER_TIM1) {
        return; /* has none that is modelled */
    }
    nvic_set_line(timer->wires.nvic, irqs[timer->wires.number], (timer->sr & timer->dier & TIMER_DIER_INTERRUPTS) != 0);
}

static void request(struct timer *timer, unsigned source, uint64_t cycle)
{
    if ((timer->dier >> TIMER_DIER_REQUESTS_SHIFT & UINT32_C(1) << source) != 0) {
        requests_raise(timer->wires.requests, timer->wires.number, source, cycle);
    }
}

/* CCDS (section 18.4.2): the channels' requests come with the compare events, or with updates. */
void timer_request_channel(struct timer *timer, unsigned channel, uint64_t cycle)
{
    if ((timer->cr2 & TIMER_CR2_CCDS) == 0) {
        request(timer, REQUEST_CHANNEL_1 + channel, cycle);
    }
}

static void request_update(struct timer *timer, bool is_told, uint64_t cycle)
{
    if (is_told) {
        request(timer, REQUEST_UPDATE, cycle);
    }
    for (unsigned i = 0; i < TIMER_CHANNELS && (timer->cr2 & TIMER_CR2_CCDS) != 0; i++) {
        request(timer, REQUEST_CHANNEL_1 + i, cycle);
    }
}

static void match(struct timer *timer, unsigned channel, uint64_t cycle)
{
    timer->matches++;
    timer->sr |= 2U << channel;
    timer_request_channel(timer, channel, cycle);
    timer_match_output(timer, channel, cycle);
}

/* An update event (section 18.3.1): what was preloaded comes into force, and a timer of one pulse stops. */
void timer_update_event(struct timer *timer, bool by_software, uint64_t cycle)
{
    if ((timer->cr1 & TIMER_CR1_UDIS) != 0) {
        return;
    }
    timer->psc_used = timer->psc;
    timer->arr_used = timer->arr;
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        timer->channel[i].compare = timer->channel[i].preload;
    }
    bool is_told = !by_software || (timer->cr1 & TIMER_CR1_URS) == 0;
    timer->sr |= is_told ? SR_UIF : 0U;
    request_update(timer, is_told, cycle);
    if ((timer->cr1 & TIMER_CR1_OPM) != 0) {
        timer->cr1 &= ~(uint32_t)TIMER_CR1_CEN;
    }
}

/* The counter turns to 0. Section 18.4.5: a channel whose value lies above ARR sets its flag now. */
static void turn(struct timer *timer, uint64_t cycle)
{
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        if (timer->channel[i].compare > timer->arr_used && !timer_is_captured(timer, i)) {
            timer->sr |= 2U << i;
            timer_request_channel(timer, i, cycle);
        }
    }
    timer->count = 0;
    timer->anchor_cycle = cycle;
    timer_update_event(timer, false, cycle);
    timer_plan(timer, cycle);
    timer_update_outputs(timer, cycle);
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        if (timer->channel[i].compare == 0 && !timer_is_captured(timer, i)) {
            match(timer, i, cycle);
        }
    }
}

static void on_event(void *model, uint64_t cycle)
{
    struct timer *timer = model;
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        if (timer->channel[i].due <= cycle) {
            timer->channel[i].due = VTIME_NEVER;
            match(timer, i, cycle);
        }
    }
    if (timer->turn_due <= cycle) {
        turn(timer, cycle);
    }
    timer_set_event(timer);
    timer_update_interrupt(timer);
}

void timer_hold(struct timer *timer)
{
    if (timer_clock_divider(timer) != 0) {
        timer_move_anchor(timer, timer->wires.clock->now);
    }
}

void timer_release(struct timer *timer)
{
    timer_plan(timer, timer->wires.clock->now);
}

void timer_reset(struct timer *timer)
{
    uint32_t all = timer_width_mask(timer);
    *timer = (struct timer){
        .wires = timer->wires, .arr = all, .arr_used = all, .start_cycle = VTIME_NEVER, .turn_due = VTIME_NEVER};
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        timer->channel[i].due = VTIME_NEVER;
        timer->channel[i].pin_driven = true; /* so that the pins are told */
        timer_update_output(timer, i, timer->wires.clock->now);
    }
    for (unsigned i = 0; i < REQUEST_SOURCES && timer->wires.number != TIMER_TIM1; i++) {
        requests_lower(timer->wires.requests, request_line(timer->wires.number, i));
    }
    timer_set_event(timer);
    if (timer->wires.number == TIMER_TIM5) {
        clock_set(timer->wires.clock, EVENT_LSI, VTIME_NEVER);
    }
    timer_update_interrupt(timer);
}

void timer_init(struct timer *timer, struct timer_wires wires)
{
    timer->wires = wires;
    timer->start_cycle = VTIME_NEVER; /* pins have edges before the first reset */
    clock_attach(wires.clock, (enum event)(EVENT_TIM2 + wires.number), on_event, timer);
}
