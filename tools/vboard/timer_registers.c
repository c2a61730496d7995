#include "timer_registers.h"

#include "timer.h"
#include "timer_capture.h"
#include "timer_output.h"

enum {
    TIM_CR1 = 0x00,
    TIM_CR2 = 0x04,
    TIM_SMCR = 0x08,
    TIM_DIER = 0x0C,
    TIM_SR = 0x10,
    TIM_EGR = 0x14,
    TIM_CCMR1 = 0x18,
    TIM_CCMR2 = 0x1C,
    TIM_CCER = 0x20,
    TIM_CNT = 0x24,
    TIM_PSC = 0x28,
    TIM_ARR = 0x2C,
    TIM_CCR1 = 0x34,
    TIM_CCR4 = 0x40,
    TIM_OR = 0x50,
    CR1_MODELLED = 0x38F, /* not counting down, not centre-aligned; CKD does nothing here */
    SR_FLAGS = 0x1E5F,
    CHANNEL_FLAGS = 0x1E,
    CCMR_PRELOAD = 1 << 3,
    CCER_MODELLED = 0xBBBB,
};

bool timer_register_is_wide(const void *model, uint32_t offset)
{
    const struct timer *timer = model;
    bool counts = offset == TIM_CNT || offset == TIM_ARR || (offset >= TIM_CCR1 && offset <= TIM_CCR4);
    return timer_is_wide(timer) && counts;
}

static uint32_t read_compare(struct timer *timer, unsigned channel)
{
    if (timer_is_captured(timer, channel)) {
        timer_take_capture(timer, channel);
    }
    return timer->channel[channel].preload;
}

bool timer_read(void *model, uint32_t offset, uint32_t *value)
{
    struct timer *timer = model;
    if (offset >= TIM_CCR1 && offset <= TIM_CCR4) {
        *value = read_compare(timer, (offset - TIM_CCR1) / 4U);
        return true;
    }
    switch (offset) {
    case TIM_CR1:
        *value = timer->cr1;
        return true;
    case TIM_CR2:
        *value = timer->cr2;
        return true;
    case TIM_DIER:
        *value = timer->dier;
        return true;
    case TIM_SR:
        *value = timer->sr;
        return true;
    case TIM_SMCR:
    case TIM_EGR:
        *value = 0;
        return true;
    case TIM_CCMR1:
    case TIM_CCMR2:
        *value = timer->ccmr[(offset - TIM_CCMR1) / 4U];
        return true;
    case TIM_CCER:
        *value = timer->ccer;
        return true;
    case TIM_CNT:
        *value = timer_count_at(timer, timer->wires.clock->now);
        return true;
    case TIM_PSC:
        *value = timer->psc;
        return true;
    case TIM_ARR:
        *value = timer->arr;
        return true;
    case TIM_OR:
        *value = timer->remap;
        return timer_is_wide(timer);
    default:
        return false;
    }
}

static void refuse(struct timer *timer, const char *what)
{
    report_fail(timer->wires.report, "a timer is asked for %s, which is not modelled", what);
}

static void write_cr1(struct timer *timer, uint32_t value)
{
    if ((value & ~(uint32_t)CR1_MODELLED) != 0) {
        refuse(timer, "counting down or centre-aligned");
    }
    timer_move_anchor(timer, timer->wires.clock->now);
    if (!timer_runs(timer) && (value & TIMER_CR1_CEN) != 0) {
        /* It begins to count one clock after CEN is set (section 18.3.2). */
        timer->anchor_cycle = timer->wires.clock->now + timer_clock_divider(timer);
        if (timer->start_cycle == VTIME_NEVER) {
            timer->start_cycle = timer->anchor_cycle;
            timer->count +=
                timer->wires.number == timer->wires.settings->steps ? (uint32_t)timer->wires.settings->start : 0U;
        }
    }
    timer->cr1 = value;
    timer->arr_used = (value & TIMER_CR1_ARPE) != 0 ? timer->arr_used : timer->arr;
    timer_plan(timer, timer->wires.clock->now);
}

static void write_egr(struct timer *timer, uint32_t value)
{
    uint64_t now = timer->wires.clock->now;
    if ((value & 1U) != 0) {
        timer->count = 0;
        timer->anchor_cycle = now;
        timer_update_event(timer, true, now);
        timer_plan(timer, now);
    }
    timer->sr |= value & CHANNEL_FLAGS; /* the flags; of the outputs section 18.4.6 says nothing */
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        if ((value & UINT32_C(2) << i) != 0) {
            timer_request_channel(timer, i, now);
        }
    }
    timer_update_outputs(timer, now);
}

/* A request that is not served before it is disabled is taken back, which the manual does not say; --requests-stay: it
 * is not. */
static void write_dier(struct timer *timer, uint32_t value)
{
    uint32_t modelled = TIMER_DIER_INTERRUPTS | TIMER_DIER_REQUESTS;
    if ((value & ~modelled) != 0) {
        refuse(timer, "interrupts or DMA by triggers");
    }
    if (timer->wires.number == TIMER_TIM1) {
        if (value != 0) {
            refuse(timer, "interrupts or DMA of TIM1");
        }
        return;
    }
    for (unsigned i = 0; i < REQUEST_SOURCES && !timer->wires.settings->requests_stay; i++) {
        if ((value >> TIMER_DIER_REQUESTS_SHIFT & UINT32_C(1) << i) == 0) {
            requests_lower(timer->wires.requests, request_line(timer->wires.number, i));
        }
    }
    timer->dier = value;
}

/* Section 18.4.7, OCxPE: without preload what is written to the register is what the counter is compared with. */
static bool preloads(const struct timer *timer, unsigned channel)
{
    return (timer->ccmr[channel / 2U] >> 8U * (channel % 2U) & CCMR_PRELOAD) != 0;
}

static void take_compare(struct timer *timer, unsigned channel)
{
    struct timer_channel *at = &timer->channel[channel];
    at->compare = at->preload;
    timer_find_match(timer, channel, timer->wires.clock->now);
    timer_set_event(timer);
    timer_update_output(timer, channel, timer->wires.clock->now);
}

static void write_ccmr(struct timer *timer, unsigned index, uint32_t value)
{
    timer_check_modes(timer, index, value);
    if ((value & 0x8080U) != 0) {
        refuse(timer, "clearing outputs by ETRF");
    }
    timer->ccmr[index] = value;
    timer_plan_capture(timer);
    for (unsigned i = 2U * index; i < 2U * index + 2U; i++) {
        if (!preloads(timer, i) && !timer_is_captured(timer, i) &&
            timer->channel[i].compare != timer->channel[i].preload) {
            take_compare(timer, i);
        } else {
            timer_update_output(timer, i, timer->wires.clock->now);
        }
    }
}

static void write_compare(struct timer *timer, unsigned channel, uint32_t value)
{
    if (timer_is_captured(timer, channel)) {
        report_fail(timer->wires.report, "TIM_CCR: the register of an input can only be read (RM0090 18.4.13)");
        return;
    }
    timer->channel[channel].preload = value & timer_width_mask(timer);
    if (!preloads(timer, channel)) {
        take_compare(timer, channel);
    }
}

static bool write_counter(void *model, uint32_t offset, uint32_t value)
{
    struct timer *timer = model;
    timer_move_anchor(timer, timer->wires.clock->now);
    switch (offset) {
    case TIM_CNT:
        timer->count = value & timer_width_mask(timer);
        timer->anchor_cycle = timer->wires.clock->now;
        break;
    case TIM_PSC:
        timer->psc = value & 0xFFFFU;
        break;
    default:
        timer->arr = value & timer_width_mask(timer);
        timer->arr_used = (timer->cr1 & TIMER_CR1_ARPE) != 0 ? timer->arr_used : timer->arr;
        break;
    }
    timer_plan(timer, timer->wires.clock->now);
    timer_update_outputs(timer, timer->wires.clock->now);
    return true;
}

static bool write_register(void *model, uint32_t offset, uint32_t value)
{
    struct timer *timer = model;
    switch (offset) {
    case TIM_CR1:
        write_cr1(timer, value);
        return true;
    case TIM_CR2:
        timer->cr2 = value;
        return true;
    case TIM_SMCR:
        if (value != 0) {
            refuse(timer, "slave mode");
        }
        return true;
    case TIM_DIER:
        write_dier(timer, value);
        return true;
    case TIM_SR: /* writing 0 clears, writing 1 does nothing */
        timer->sr &= value | ~(uint32_t)SR_FLAGS;
        return true;
    case TIM_EGR:
        write_egr(timer, value);
        return true;
    case TIM_CCMR1:
    case TIM_CCMR2:
        write_ccmr(timer, (offset - TIM_CCMR1) / 4U, value);
        return true;
    case TIM_CCER:
        timer_check_enables(timer, value);
        timer->ccer = value & CCER_MODELLED;
        timer_plan_capture(timer);
        timer_update_outputs(timer, timer->wires.clock->now);
        return true;
    case TIM_CNT:
    case TIM_PSC:
    case TIM_ARR:
        return write_counter(timer, offset, value);
    case TIM_OR:
        timer->remap = value;
        timer_plan_capture(timer);
        return timer_is_wide(timer) && (value == 0 || (timer->wires.number != 0 && value == TIMER_OR_TI4_LSI));
    default:
        return false;
    }
}

bool timer_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct timer *timer = model;
    bool known = true;
    if (mask != UINT32_MAX && offset != TIM_SR) {
        uint32_t before = 0;
        known = timer_read(timer, offset, &before);
        value = (before & ~mask) | (value & mask);
    } else if (mask != UINT32_MAX) {
        value |= ~mask;
    }
    if (offset >= TIM_CCR1 && offset <= TIM_CCR4) {
        write_compare(timer, (offset - TIM_CCR1) / 4U, value);
    } else {
        known = known && write_register(timer, offset, value);
    }
    timer_update_interrupt(timer);
    return known;
}
