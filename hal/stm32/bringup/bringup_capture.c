#include <stddef.h>

#include "base_tick.h"
#include "bringup.h"
#include "hal_board.h"
#include "hal_time.h"
#include "stm32_pins.h"
#include "stm32_private.h"
#include "stm32_step_times.h"

/*
 * What a STEP pin makes, measured by a timer that has nothing to do with it: a wire brings it to a pin whose timer
 * captures the rising edge with channel 1 and the falling one with channel 2 (RM0090 18.3.6). That timer has 16 bits;
 * the unit's time, looked at when a pulse is fetched, tells how often it has turned meanwhile.
 */
enum {
    PULSES = 16,
    CAPTURES_MAX = 24, /* more than were asked for are told, too */
    BEGIN_MS = 3,
    REST_MS = 2, /* after the last one */
    LEAST_INTERVAL_US = 60,
    STRIDE = 7, /* the intervals are mixed, so that each is another one */
    STEP_US = 5,

    OWN_INPUT = 1,   /* CCxS: TI1 for channel 1, */
    OTHER_INPUT = 2, /* and for channel 2 */
    TURN = 1 << 16,
    TURN_MASK = TURN - 1,
    PULL_UP = 1,
    PULL_DOWN = 2,
    MODE_INPUT = 0,
    MODE_ALTERNATE = 2,
    PULL_MS = 1,

    SOURCE_TIM1_CH1 = 0,
    SOURCE_TIM4_CH1,
    NO_SOURCE,
};

/* A board without such a pin says nothing of it. */
#ifndef BOARD_CAPTURE_PINS
#define BOARD_CAPTURE_PINS(X)
#endif

static const struct pin {
    uint8_t pin;
    uint8_t source;
} pins[] = {
#define X(signal, port, pin, use) {16 * STM32_PORT_##port + (pin), SOURCE_##use},
    BOARD_CAPTURE_PINS(X)
#undef X
        {0, NO_SOURCE},
};

struct timer {
    uintptr_t base;
    volatile uint32_t *clock;
    uint32_t clock_bit;
    uint32_t function; /* alternate function, DS8626 table 9 */
    const uint32_t *bus_hz;
};

static const struct timer timers[] = {
    [SOURCE_TIM1_CH1] = {TIM1_BASE, &RCC_APB2ENR, RCC_APB2ENR_TIM1EN, 1, &stm32_board_clock.apb2_hz},
    [SOURCE_TIM4_CH1] = {TIM4_BASE, &RCC_APB1ENR, RCC_APB1ENR_TIM4EN, 2, &stm32_board_clock.apb1_hz},
};

struct captured {
    uint32_t count;
    bool lost; /* a capture came before the last had been read */
    uint32_t rise;
    uint32_t tick; /* the unit's, when that was fetched */
    uint32_t interval[CAPTURES_MAX];
    uint32_t width[CAPTURES_MAX];
};

/* From pulse `i` to the next one. */
static uint32_t interval_ticks(uint32_t i)
{
    uint32_t us = (uint32_t)LEAST_INTERVAL_US + i * (uint32_t)STRIDE % (uint32_t)PULSES * (uint32_t)STEP_US;
    return us * (uint32_t)TICKS_PER_US + i;
}

static void set_field(volatile uint32_t *word, uint32_t place, uint32_t width, uint32_t value)
{
    uint32_t mask = ((UINT32_C(1) << width) - 1U) << place;
    *word = (*word & ~mask) | value << place;
}

static void set_mode(uint32_t mode, uint32_t function)
{
    uint32_t port = pins[0].pin / 16U;
    uint32_t pin = pins[0].pin % 16U;
    volatile uint32_t *alternate = pin < 8U ? &GPIO_AFRL(port) : &GPIO_AFRH(port);
    set_field(alternate, 4U * (pin % 8U), 4U, function);
    set_field(&GPIO_MODER(port), 2U * pin, 2U, mode);
}

static void set_pull(uint32_t pull)
{
    set_field(&GPIO_PUPDR(pins[0].pin / 16U), 2U * (pins[0].pin % 16U), 2U, pull);
}

void bringup_capture_start(void)
{
    if (pins[0].source != NO_SOURCE) {
        stm32_enable_clock(&RCC_AHB1ENR, RCC_AHB1ENR_GPIOAEN << pins[0].pin / 16U);
        set_mode(MODE_INPUT, 0);
        set_pull(PULL_DOWN);
    }
}

bool bringup_capture_read(void)
{
    return pins[0].source != NO_SOURCE && stm32_pin_read(pins[0].pin);
}

/* A pin to which no wire leads follows its pull resistor. */
static void tell_pulled(void)
{
    say_name("pulled");
    for (uint32_t pull = PULL_UP; pull <= (uint32_t)PULL_DOWN; pull++) {
        set_pull(pull);
        bringup_wait(PULL_MS);
        say_decimal(bringup_capture_read() ? 1U : 0U);
    }
    say_line_end();
}

/* Pulses are high or low, as the board has them. */
static void start_timer(const struct timer *timer)
{
    stm32_enable_clock(timer->clock, timer->clock_bit);
    TIM_PSC(timer->base) = 0;
    TIM_ARR(timer->base) = UINT16_MAX;
    TIM_EGR(timer->base) = TIM_EGR_UG;
    TIM_CCMR1(timer->base) = TIM_CCMR1_CC1S((uint32_t)OWN_INPUT) | TIM_CCMR1_CC2S((uint32_t)OTHER_INPUT);
    TIM_CCER(timer->base) = TIM_CCER_CC1E | TIM_CCER_CC2E | (BOARD_STEP_LEVEL == 1U ? TIM_CCER_CC2P : TIM_CCER_CC1P);
    TIM_CR1(timer->base) = TIM_CR1_CEN;
    set_mode(MODE_ALTERNATE, timer->function);
    (void)TIM_CCR1(timer->base);
    (void)TIM_CCR2(timer->base);
    TIM_SR(timer->base) = 0;
}

static void end_timer(const struct timer *timer)
{
    TIM_CR1(timer->base) = 0;
    TIM_CCER(timer->base) = 0;
    TIM_CCMR1(timer->base) = 0;
    stm32_barrier();
    *timer->clock &= ~timer->clock_bit;
    set_mode(MODE_INPUT, 0);
}

static uint32_t capture_hz(const struct timer *timer)
{
    return bringup_timer_hz(*timer->bus_hz);
}

/* Ticks of the timer, whose turns follow from about how many there were. */
static uint32_t unwind(uint32_t ticks, uint32_t about)
{
    uint32_t part = ticks & (uint32_t)TURN_MASK;
    uint32_t turns = about + (uint32_t)TURN / 2U < part ? 0U : (about + (uint32_t)TURN / 2U - part) / (uint32_t)TURN;
    return part + turns * (uint32_t)TURN;
}

static void note_pulse(const struct timer *timer, struct captured *captured)
{
    uint32_t tick = TIM2_CNT;
    uint32_t rise = TIM_CCR1(timer->base);
    uint32_t fall = TIM_CCR2(timer->base);
    uint32_t scale = capture_hz(timer) / (uint32_t)TICK_HZ;
    if (captured->count < (uint32_t)CAPTURES_MAX) {
        uint32_t place = captured->count;
        captured->interval[place] = unwind(rise - captured->rise, (tick - captured->tick) * scale);
        captured->width[place] = (fall - rise) & (uint32_t)TURN_MASK;
        captured->count++;
    }
    captured->rise = rise;
    captured->tick = tick;
}

/* A falling edge without a rising one is the end of something that began before. */
static void look(const struct timer *timer, struct captured *captured)
{
    uint32_t flags = TIM_SR(timer->base);
    captured->lost = captured->lost || (flags & (TIM_SR_CC1OF | TIM_SR_CC2OF)) != 0;
    if ((flags & TIM_SR_CC2IF) == 0) {
        return;
    }
    if ((flags & TIM_SR_CC1IF) != 0) {
        note_pulse(timer, captured);
    } else {
        (void)TIM_CCR2(timer->base);
    }
}

static void make_pulses(const struct timer *timer, uint32_t number, struct captured *captured)
{
    uint64_t now = hal_time_now();
    uint64_t end = now + (uint64_t)(BEGIN_MS + REST_MS) * TICKS_PER_MS;
    for (uint32_t i = 0; i < (uint32_t)PULSES; i++) {
        end += interval_ticks(i);
    }
    hal_step_hold();
    uint32_t first = (uint32_t)now + (uint32_t)(BEGIN_MS * TICKS_PER_MS);
    bringup_train_begin(number - 1U, first, (uint32_t)PULSES, interval_ticks);
    hal_step_release();
    while (hal_time_now() < end) {
        look(timer, captured);
    }
}

static void tell_wanted(void)
{
    say_name("wanted_width");
    say_decimal(HIGH_TICKS);
    say_line_end();
    say_name("wanted");
    for (uint32_t i = 0; i + 1U < (uint32_t)PULSES; i++) {
        say_decimal(interval_ticks(i));
    }
    say_line_end();
}

static void tell_captured(const struct captured *captured)
{
    say_number("captured", captured->count);
    say_number("overrun", captured->lost ? 1U : 0U);
    say_name("intervals");
    for (uint32_t i = 1; i < captured->count; i++) {
        say_decimal(captured->interval[i]);
    }
    say_line_end();
    say_name("widths");
    for (uint32_t i = 0; i < captured->count; i++) {
        say_decimal(captured->width[i]);
    }
    say_line_end();
}

const char *bringup_capture_tell(uint32_t number)
{
    struct captured captured = {.count = 0};
    if (number == 0 || number > (uint32_t)UNIT_MOTORS) {
        return "number";
    }
    if (pins[0].source == NO_SOURCE) {
        return "no_capture";
    }
    if (!hal_board_may_move()) {
        return "no_crystal";
    }
    const struct timer *timer = &timers[pins[0].source];
    uint32_t late = hal_board_late_steps();
    tell_pulled();
    start_timer(timer);
    make_pulses(timer, number, &captured);
    end_timer(timer);
    say_number("tick_hz", TICK_HZ);
    say_number("capture_hz", capture_hz(timer));
    say_number("made", bringup_train_count_made(number - 1U));
    say_number("late", hal_board_late_steps() - late);
    tell_wanted();
    tell_captured(&captured);
    return NULL;
}
