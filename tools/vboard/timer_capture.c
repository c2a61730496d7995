#include "timer_capture.h"

#include "timer_pins.h"

enum {
    CHANNEL_4 = 3,
    FIRST_FLAG = 1 << 1, /* CC1IF */
    FIRST_OVER = 1 << 9, /* CC1OF */
    ENABLE = 1 << 0,     /* CC1E */
    FALLING = 1 << 1,    /* CC1P */
    BOTH = 1 << 3,       /* CC1NP; with CC1P: both edges */
    INPUTS = 0x303,      /* CCxS of both channels of a register */
    OWN_INPUT = 1,       /* CCxS: TIx of the channel itself */
    OTHER_INPUT = 2,     /* that of the other channel of the pair: 1 and 2, 3 and 4 */
};

static uint32_t mode_of(const struct timer *timer, unsigned channel)
{
    return timer->ccmr[channel / 2U] >> 8U * (channel % 2U) & 0xFFU;
}

static uint32_t enable_of(const struct timer *timer, unsigned channel)
{
    return timer->ccer >> 4U * channel & 0xFU;
}

static void check_mode(const struct timer *timer, unsigned channel, uint32_t mode)
{
    bool changes = ((mode ^ mode_of(timer, channel)) & 3U) != 0;
    if (changes && (enable_of(timer, channel) & ENABLE) != 0) {
        report_fail(timer->wires.report, "TIM_CCMR: CCxS is written while the channel is on (RM0090 18.4.7)");
    }
    if ((mode & 3U) > OTHER_INPUT || ((mode & 3U) != 0 && (mode & 0xF0U) != 0)) {
        report_fail(timer->wires.report, "a timer is asked for capture of a trigger or by a filter, which is not "
                                         "modelled");
    }
}

void timer_check_modes(const struct timer *timer, unsigned index, uint32_t value)
{
    check_mode(timer, 2U * index, value & 0xFFU);
    check_mode(timer, 2U * index + 1U, value >> 8U & 0xFFU);
}

/* Section 18.4.9: CCxNP must be kept cleared for an output; for an input it means both edges, and nothing by itself. */
void timer_check_enables(const struct timer *timer, uint32_t value)
{
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        uint32_t enable = value >> 4U * i & 0xFU;
        if ((enable & BOTH) != 0 && !timer_is_captured(timer, i)) {
            report_fail(timer->wires.report, "TIM_CCER: CCxNP must be kept cleared for an output (RM0090 18.4.9)");
        } else if ((enable & ENABLE) != 0 && timer->wires.number == TIMER_TIM1 && !timer_is_captured(timer, i)) {
            report_fail(timer->wires.report, "TIM_CCER: outputs of TIM1 are not modelled");
        } else if ((enable & (BOTH | FALLING)) == BOTH) {
            report_fail(timer->wires.report, "TIM_CCER: CCxNP without CCxP is reserved (RM0090 18.4.9)");
        }
    }
}

static bool hears_lsi(const struct timer *timer)
{
    return timer->wires.number == TIMER_TIM5 && timer_is_captured(timer, CHANNEL_4) &&
           (enable_of(timer, CHANNEL_4) & ENABLE) != 0 && timer->remap == TIMER_OR_TI4_LSI;
}

/* The first half period after a moment. */
static void plan_next(struct timer *timer, uint64_t ps)
{
    uint64_t halves = vtime_scale(ps, 2U * timer->wires.lsi_hz, VTIME_PS_PER_SECOND) + 1U;
    timer->lsi_level = halves % 2U == 0;
    clock_set_ps(timer->wires.clock, EVENT_LSI,
                 vtime_scale(halves, VTIME_PS_PER_SECOND, 2U * timer->wires.lsi_hz) + 1U);
}

void timer_plan_capture(struct timer *timer)
{
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        if ((enable_of(timer, i) & ENABLE) == 0) {
            timer->channel[i].edges = 0; /* the prescaler, section 18.4.7 */
        }
    }
    if (timer->wires.number != TIMER_TIM5) {
        return;
    }
    if (!hears_lsi(timer)) {
        timer->hears_lsi = false;
        clock_set(timer->wires.clock, EVENT_LSI, VTIME_NEVER);
    } else if (!timer->hears_lsi) {
        timer->hears_lsi = true;
        plan_next(timer, clock_now_ps(timer->wires.clock));
    }
}

static void capture(struct timer *timer, unsigned channel, uint64_t cycle)
{
    uint32_t flag = (uint32_t)FIRST_FLAG << channel;
    timer->sr |= (timer->sr & flag) != 0 ? (uint32_t)FIRST_OVER << channel : flag;
    timer->channel[channel].preload = timer_count_at(timer, cycle) & timer_width_mask(timer);
    timer_request_channel(timer, channel, cycle);
    timer_update_interrupt(timer);
}

static void note_edge(struct timer *timer, unsigned channel, bool rises, uint64_t cycle)
{
    struct timer_channel *at = &timer->channel[channel];
    uint32_t enable = enable_of(timer, channel);
    bool falls_only = (enable & (BOTH | FALLING)) == FALLING;
    bool counts = (enable & BOTH) != 0 || rises != falls_only;
    unsigned every = 1U << (mode_of(timer, channel) >> 2U & 3U);
    if (counts && ++at->edges >= every) {
        at->edges = 0;
        capture(timer, channel, cycle);
    }
}

/* An edge at TIx, for the channels that hear it. */
static void note_input(struct timer *timer, unsigned input, bool rises, uint64_t cycle)
{
    for (unsigned channel = 0; channel < TIMER_CHANNELS; channel++) {
        uint32_t heard = mode_of(timer, channel) & 3U;
        bool hears = (heard == OWN_INPUT && channel == input) || (heard == OTHER_INPUT && (channel ^ 1U) == input);
        if (hears && (enable_of(timer, channel) & ENABLE) != 0) {
            note_edge(timer, channel, rises, cycle);
        }
    }
}

static bool has_pin(const struct timer *timer, unsigned channel, struct pin pin)
{
    for (unsigned i = 0; i < TIMER_PINS_PER_CHANNEL; i++) {
        const struct pin *own = timer_pin(timer->wires.number, channel, i);
        if (own != NULL && own->port == pin.port && own->number == pin.number) {
            return gpio_has_function(timer->wires.gpio, pin, timer_function(timer->wires.number));
        }
    }
    return false;
}

void timer_note_pin(struct timer *timer, struct pin pin, bool rises, uint64_t cycle)
{
    if (((timer->ccmr[0] | timer->ccmr[1]) & INPUTS) == 0 || !timer_runs(timer)) {
        return;
    }
    for (unsigned channel = 0; channel < TIMER_CHANNELS; channel++) {
        bool taken = channel == (unsigned)CHANNEL_4 && timer->remap == TIMER_OR_TI4_LSI;
        if (!taken && has_pin(timer, channel, pin)) {
            note_input(timer, channel, rises, cycle);
        }
    }
}

void timer_take_capture(struct timer *timer, unsigned channel)
{
    timer->sr &= ~((uint32_t)FIRST_FLAG << channel);
    timer_update_interrupt(timer);
}

static void on_lsi_event(void *model, uint64_t cycle)
{
    struct timer *timer = model;
    bool rises = timer->lsi_level;
    uint64_t ps = clock_ps_of_cycle(timer->wires.clock, cycle);
    if (rcc_lsi_runs(timer->wires.rcc) && timer_runs(timer)) {
        note_input(timer, CHANNEL_4, rises, cycle);
    }
    plan_next(timer, ps);
}

void timer_capture_init(struct timer *timer)
{
    clock_attach(timer->wires.clock, EVENT_LSI, on_lsi_event, timer);
}
