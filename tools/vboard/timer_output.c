#include "timer_output.h"

#include "timer_pins.h"

enum {
    MODE_FROZEN,
    MODE_ACTIVE,   /* at a match */
    MODE_INACTIVE, /* at a match */
    MODE_TOGGLE,   /* at a match */
    MODE_FORCE_INACTIVE,
    MODE_FORCE_ACTIVE,
    MODE_PWM1,
    MODE_PWM2,
};

static unsigned output_mode(const struct timer *timer, unsigned channel)
{
    return timer->ccmr[channel / 2U] >> (8U * (channel % 2U) + 4U) & 7U;
}

static void tell_pins(struct timer *timer, unsigned channel, uint64_t cycle)
{
    struct timer_channel *at = &timer->channel[channel];
    uint32_t enable = timer->ccer >> 4U * channel;
    bool driven = (enable & 1U) != 0 && !timer_is_captured(timer, channel);
    bool level = driven && at->reference != ((enable & 2U) != 0);
    if (level == at->pin_level && driven == at->pin_driven) {
        return;
    }
    at->pin_level = level;
    at->pin_driven = driven;
    for (unsigned i = 0; i < TIMER_PINS_PER_CHANNEL; i++) {
        const struct pin *pin = timer_pin(timer->wires.number, channel, i);
        if (pin != NULL) {
            gpio_drive(timer->wires.gpio, *pin, timer_function(timer->wires.number), driven, level, cycle);
        }
    }
}

/* Section 18.4.7: in PWM mode the level changes only when the result of the comparison does, or when the mode was
 * "frozen" before. What a channel shows that comes from another mode is not said; --pwm-at-once: the comparison. */
void timer_update_output(struct timer *timer, unsigned channel, uint64_t cycle)
{
    struct timer_channel *at = &timer->channel[channel];
    unsigned mode = output_mode(timer, channel);
    bool below = timer_count_at(timer, cycle) < at->compare;
    bool follows =
        below != at->below || at->mode == MODE_FROZEN || (timer->wires.settings->pwm_at_once && mode != at->mode);
    at->mode = (uint8_t)mode;
    at->below = below;
    switch (mode) {
    case MODE_FORCE_INACTIVE:
    case MODE_FORCE_ACTIVE:
        at->reference = mode == MODE_FORCE_ACTIVE;
        break;
    case MODE_PWM1: /* active as long as the counter is below the value */
    case MODE_PWM2:
        at->reference = follows ? below == (mode == MODE_PWM1) : at->reference;
        break;
    default:
        break;
    }
    tell_pins(timer, channel, cycle);
}

void timer_update_outputs(struct timer *timer, uint64_t cycle)
{
    for (unsigned i = 0; i < TIMER_CHANNELS; i++) {
        timer_update_output(timer, i, cycle);
    }
}

void timer_match_output(struct timer *timer, unsigned channel, uint64_t cycle)
{
    struct timer_channel *at = &timer->channel[channel];
    switch (output_mode(timer, channel)) {
    case MODE_ACTIVE:
        at->reference = true;
        break;
    case MODE_INACTIVE:
        at->reference = false;
        break;
    case MODE_TOGGLE:
        at->reference = !at->reference;
        break;
    default:
        break;
    }
    timer_update_output(timer, channel, cycle);
}
