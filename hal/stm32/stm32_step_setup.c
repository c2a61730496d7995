#include <stddef.h>

#include "hal_board.h"
#include "stm32_pins.h"
#include "stm32_step_private.h"

/*
 * What makes the edges of a pin: a channel of a timer (DS8626, table 9), and the stream of DMA1 and its channel that
 * hear it (RM0090, table 42). TIM2 calls the step interrupt by its channel 4. Each stream is here once; TIM5_CH4 could
 * also be at stream 1, where TIM2_CH3 is.
 *
 * X(use, timer, channel from 0, stream, channel of the stream)
 */
#define OUTPUTS(X)                                                                                                     \
    X(TIM2_CH1, 0, 0, 5, 3)                                                                                            \
    X(TIM2_CH2, 0, 1, 6, 3)                                                                                            \
    X(TIM2_CH3, 0, 2, 1, 3)                                                                                            \
    X(TIM5_CH1, 1, 0, 2, 6)                                                                                            \
    X(TIM5_CH2, 1, 1, 4, 6)                                                                                            \
    X(TIM5_CH3, 1, 2, 0, 6)                                                                                            \
    X(TIM5_CH4, 1, 3, 3, 6)

/* What turns a DIR pin. */
#define TURNS(X)                                                                                                       \
    X(TIM3_CH1, 0)                                                                                                     \
    X(TIM3_CH2, 1)                                                                                                     \
    X(TIM3_CH3, 2)                                                                                                     \
    X(TIM3_CH4, 3)

/* Also what a board's other pins are for, so that each pin has a number. */
enum output {
#define X(use, timer, channel, stream, request) OUTPUT_##use,
    OUTPUTS(X)
#undef X
#define X(use, channel) OUTPUT_##use,
    TURNS(X)
#undef X
        OUTPUT_IN,
    OUTPUT_IN_UP,
    OUTPUT_OUT,
    OUTPUT_USART1,
    OUTPUT_USART2,
    OUTPUT_USART3,
};

enum output_of {
#define X(signal, port, pin, use) OUTPUT_OF_##signal = OUTPUT_##use,
    BOARD_PINS(X)
#undef X
};

struct source {
    uint8_t timer;
    uint8_t channel;
    uint8_t stream;
    uint8_t request;
};

static const struct source sources[] = {
#define X(use, timer, channel, stream, request) {timer, channel, stream, request},
    OUTPUTS(X)
#undef X
};

enum {
    TIMERS = 3,
    TURN_TIMER = 2,
    TURN_CHANNELS = 4,
    SOURCES = sizeof sources / sizeof sources[0],
    TO_PERIPHERAL = 1, /* DMA_CR: direction, size of a word, priority (RM0090 10.5.5) */
    WORDS = 2,
    VERY_HIGH = 3,
    ALIGN_TRIES = 8,
};
static_assert((unsigned)OUTPUT_OF_STEP_1 < (unsigned)SOURCES && (unsigned)OUTPUT_OF_STEP_2 < (unsigned)SOURCES &&
                  (unsigned)OUTPUT_OF_STEP_3 < (unsigned)SOURCES && (unsigned)OUTPUT_OF_STEP_4 < (unsigned)SOURCES,
              "a timer makes the edges of every STEP pin");
#define IS_TURN(use) ((unsigned)(use) - (unsigned)OUTPUT_TIM3_CH1 < (unsigned)TURN_CHANNELS)
static_assert(IS_TURN(OUTPUT_OF_DIR_1) && IS_TURN(OUTPUT_OF_DIR_2) && IS_TURN(OUTPUT_OF_DIR_3) &&
                  IS_TURN(OUTPUT_OF_DIR_4),
              "TIM3 turns every DIR pin");

static const uintptr_t timers[TIMERS] = {TIM2_BASE, TIM5_BASE, TIM3_BASE};
static const uint8_t outputs[UNIT_MOTORS] = {OUTPUT_OF_STEP_1, OUTPUT_OF_STEP_2, OUTPUT_OF_STEP_3, OUTPUT_OF_STEP_4};
static const uint8_t turns[UNIT_MOTORS] = {OUTPUT_OF_DIR_1, OUTPUT_OF_DIR_2, OUTPUT_OF_DIR_3, OUTPUT_OF_DIR_4};

static void wait_until_past(uint32_t start, uint32_t ticks)
{
    while (TIM2_CNT - start < ticks) {
    }
}

/* After the last pulse, and before the next, DIR has to stand still. */
static void wait_before_change(const struct stm32_channel *channel)
{
    wait_until_past(channel->last_tick, HOLD_TICKS);
}

static void wait_after_change(void)
{
    wait_until_past(TIM2_CNT, SETUP_TICKS);
}

static void show_direction(const struct stm32_channel *channel)
{
    hal_step_hold();
    set_mode(&channel->direction, direction_level(channel) ? MODE_HIGH : MODE_LOW);
    hal_step_release();
}

static void set_pins(unsigned motor, bool backward, bool connected)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    if (channel->backward == backward && channel->connected == connected) {
        return;
    }
    wait_before_change(channel);
    channel->backward = backward;
    channel->connected = connected;
    show_direction(channel);
    wait_after_change();
}

void hal_step_set_direction(unsigned motor, bool backward)
{
    set_pins(motor, backward, stm32_step.channel[motor].connected);
}

/* STEP is low at rest, connected or not: the next stream is started in the right mode. Without the crystal nothing is
 * ever connected. */
void hal_step_connect(unsigned motor, bool connected)
{
    set_pins(motor, stm32_step.channel[motor].backward, connected && stm32_step.may_move);
}

/* The channel at rest forces its output inactive, so the pin changes once, with the polarity of that. */
static void set_falling(const struct stm32_channel *channel, bool falling)
{
    bool inverted = falling == (BOARD_STEP_LEVEL == 1U);
    uint32_t others = TIM_CCER(channel->timer) & ~channel->falling_bit;
    TIM_CCER(channel->timer) = inverted ? others | channel->falling_bit : others;
}

void hal_step_set_polarity(unsigned motor, bool falling, bool turned)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    wait_before_change(channel);
    set_falling(channel, falling);
    channel->reversed = turned;
    show_direction(channel);
    wait_after_change();
}

static uint32_t both(uint32_t mode)
{
    return TIM_CCMR1_OC1M(mode) | TIM_CCMR1_OC2M(mode);
}

static void start_timer(unsigned timer)
{
    uintptr_t base = timers[timer];
    uint32_t low = both(timer == (unsigned)TURN_TIMER && BOARD_DIR_LEVEL == 0U ? MODE_HIGH : MODE_LOW);
    TIM_CR1(base) = 0;
    TIM_PSC(base) = 0;
    TIM_ARR(base) = timer == (unsigned)TURN_TIMER ? UINT16_MAX : UINT32_MAX;
    TIM_EGR(base) = TIM_EGR_UG;
    TIM_CCMR1(base) = low;
    TIM_CCMR2(base) = low;
    stm32_step.modes[timer][0] = low;
    stm32_step.modes[timer][1] = low;
    TIM_SR(base) = 0;
    TIM_CR1(base) = TIM_CR1_CEN;
}

/* A timer counts what TIM2 does, as far as its bits go. Looks at their counters take the same time each, so the middle
 * one lies half-way; with the addresses known, that is to the tick. */
__attribute__((always_inline)) static inline void align_timer(uintptr_t base, uint32_t bits)
{
    uint32_t lead = 0;
    for (unsigned i = 0; i < (unsigned)ALIGN_TRIES; i++) {
        TIM_CNT(base) = (TIM2_CNT + lead) & bits;
        uint32_t before = TIM2_CNT;
        uint32_t other = TIM_CNT(base);
        uint32_t after = TIM2_CNT;
        lead -= (other - before - (after - before) / 2U) & bits;
    }
}

static struct stm32_output output_of(unsigned timer, unsigned channel)
{
    return (struct stm32_output){
        .compare = &TIM_CCR1(timers[timer]) + channel,
        .mode = &TIM_CCMR1(timers[timer]) + channel / 2U,
        .modes = &stm32_step.modes[timer][channel / 2U],
        .mode_one = channel % 2U == 0 ? TIM_CCMR1_OC1M(1U) : TIM_CCMR1_OC2M(1U),
    };
}

static void set_up_stream(const struct stm32_channel *channel, uint32_t request)
{
    DMA_CR(channel->stream) = DMA_CR_DIR((uint32_t)TO_PERIPHERAL) | DMA_CR_CIRC | DMA_CR_MINC |
                              DMA_CR_PSIZE((uint32_t)WORDS) | DMA_CR_MSIZE((uint32_t)WORDS) |
                              DMA_CR_PL((uint32_t)VERY_HIGH) | DMA_CR_CHSEL(request);
    DMA_FCR(channel->stream) = 0;
    DMA_PAR(channel->stream) = (uint32_t)(uintptr_t)channel->step.compare;
    DMA_M0AR(channel->stream) = (uint32_t)(uintptr_t)channel->ring;
}

static void set_up(unsigned motor, bool may_move)
{
    const struct source *source = &sources[outputs[motor]];
    uintptr_t base = timers[source->timer];
    unsigned turn = (unsigned)turns[motor] - (unsigned)OUTPUT_TIM3_CH1;
    unsigned stream = source->stream % 4U;
    struct stm32_channel *channel = &stm32_step.channel[motor];
    *channel = (struct stm32_channel){
        .stream = DMA1_STREAM(source->stream),
        .timer = base,
        .step = output_of(source->timer, source->channel),
        .direction = output_of(TURN_TIMER, turn),
        .asks = &stm32_step.asks[source->timer],
        .event = TIM_SR_CC1IF << source->channel,
        .clear = source->stream < 4U ? &DMA1_LIFCR : &DMA1_HIFCR,
        .flags = (uint32_t)STREAM_FLAGS << (stream % 2U * 6U + stream / 2U * 16U),
        .connected = may_move,
        .falling_bit = TIM_CCER_CC1P << (4U * source->channel),
    };
    set_up_stream(channel, source->request);
    set_falling(channel, false);
    TIM_CCER(base) |= TIM_CCER_CC1E << (4U * source->channel);
    TIM_CCER(TIM3_BASE) |= TIM_CCER_CC1E << (4U * turn);
}

/* All STEP and DIR pins low and the counters running; the pins may be handed over to the timers now. */
void stm32_step_start(bool may_move)
{
    stm32_enable_clock(&RCC_APB1ENR, RCC_APB1ENR_TIM2EN | RCC_APB1ENR_TIM3EN | RCC_APB1ENR_TIM5EN);
    stm32_enable_clock(&RCC_AHB1ENR, RCC_AHB1ENR_DMA1EN);
    stm32_step.may_move = may_move;
    for (unsigned timer = 0; timer < TIMERS; timer++) {
        start_timer(timer);
    }
    align_timer(TIM5_BASE, UINT32_MAX);
    align_timer(TIM3_BASE, UINT16_MAX);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        set_up(motor, may_move);
    }
    stm32_step.asks[0] = TIM_DIER_CC4IE;
    TIM_DIER(TIM2_BASE) = TIM_DIER_CC4IE;
    TIM_EGR(TIM2_BASE) = TIM_EGR_CC4G; /* from its first time on the interrupt says when it comes next */
}

void stm32_step_set_client(const struct hal_client *client)
{
    stm32_step.client = *client;
}

/* Also before stm32_step_start. */
void stm32_step_make_safe(void)
{
    uint32_t low = both(MODE_LOW);
    stm32_enable_clock(&RCC_APB1ENR, RCC_APB1ENR_TIM2EN | RCC_APB1ENR_TIM5EN);
    for (unsigned timer = 0; timer < (unsigned)TURN_TIMER; timer++) {
        TIM_DIER(timers[timer]) = 0;
        TIM_CCMR1(timers[timer]) = low;
        TIM_CCMR2(timers[timer]) = low;
    }
}

bool stm32_step_is_stuck(void)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        const struct stm32_channel *channel = &stm32_step.channel[motor];
        uint32_t mask = stm32_mask();
        bool active = channel->active;
        int32_t overdue = (int32_t)(TIM2_CNT - channel->due_tick);
        stm32_unmask(mask);
        if (active && overdue > (int32_t)STUCK_TICKS) {
            return true;
        }
    }
    return false;
}

bool stm32_step_is_quiet(void)
{
    bool quiet = true;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        quiet = quiet && !stm32_step.channel[motor].active;
    }
    return quiet;
}

bool hal_board_steps_are_timed(void)
{
    return true;
}
