#include "hal_board.h"
#include "stm32_gpio_private.h"

enum {
    EXCEPTIONS = 16
};

extern uint32_t stm32_vectors[];

static const uint8_t step_pins[UNIT_MOTORS] = {STM32_PIN_STEP_1, STM32_PIN_STEP_2, STM32_PIN_STEP_3, STM32_PIN_STEP_4};
static const uint8_t direction_pins[UNIT_MOTORS] = {STM32_PIN_DIR_1, STM32_PIN_DIR_2, STM32_PIN_DIR_3, STM32_PIN_DIR_4};

uint32_t stm32_gpio_direction_bits(unsigned motor)
{
    const struct stm32_gpio_channel *channel = &stm32_gpio.channel[motor];
    bool high = ((channel->connected && channel->backward) != channel->reversed) == (BOARD_DIR_LEVEL == 1U);
    return UINT32_C(1) << (direction_pins[motor] % 16U + (high ? 0U : 16U));
}

static void wait_until_past(uint32_t start, uint32_t ticks)
{
    while (TIM2_CNT - start < ticks) {
    }
}

/* What BSRR takes for a level of STEP. */
static uint32_t bits_of(unsigned motor, bool active)
{
    bool high = (active != stm32_gpio.channel[motor].falling) == (BOARD_STEP_LEVEL == 1U);
    return UINT32_C(1) << (step_pins[motor] % 16U + (high ? 0U : 16U));
}

static void connect(struct stm32_gpio_channel *channel, unsigned motor, bool connected)
{
    channel->connected = connected;
    channel->high_bits = connected ? bits_of(motor, true) : 0U;
}

/* After the last pulse, and before the next, DIR has to stand still. */
static void wait_before_change(const struct stm32_gpio_channel *channel)
{
    wait_until_past(channel->risen_tick, HOLD_TICKS);
    while (channel->high) {
    }
}

static void show_direction(unsigned motor)
{
    *stm32_gpio.channel[motor].direction = stm32_gpio_direction_bits(motor);
    wait_until_past(TIM2_CNT, SETUP_TICKS);
}

static void set_pins(unsigned motor, bool backward, bool connected)
{
    struct stm32_gpio_channel *channel = &stm32_gpio.channel[motor];
    if (channel->backward == backward && channel->connected == connected) {
        return;
    }
    wait_before_change(channel);
    channel->backward = backward;
    connect(channel, motor, connected);
    show_direction(motor);
}

void hal_step_set_direction(unsigned motor, bool backward)
{
    set_pins(motor, backward, stm32_gpio.channel[motor].connected);
}

/* Without the crystal nothing is ever connected. */
void hal_step_connect(unsigned motor, bool connected)
{
    set_pins(motor, stm32_gpio.channel[motor].backward, connected && stm32_gpio.may_move);
}

/* No edge is pending: the pin goes to its new level at rest. */
void hal_step_set_polarity(unsigned motor, bool falling, bool turned)
{
    struct stm32_gpio_channel *channel = &stm32_gpio.channel[motor];
    wait_before_change(channel);
    channel->falling = falling;
    channel->reversed = turned;
    channel->low_bits = bits_of(motor, false);
    connect(channel, motor, channel->connected);
    *channel->pin = channel->low_bits;
    show_direction(motor);
}

static void start_timer(void)
{
    TIM_CR1(TIM2_BASE) = 0;
    TIM_PSC(TIM2_BASE) = 0;
    TIM_ARR(TIM2_BASE) = UINT32_MAX;
    TIM_EGR(TIM2_BASE) = TIM_EGR_UG;
    TIM_SR(TIM2_BASE) = 0;
    TIM_CR1(TIM2_BASE) = TIM_CR1_CEN;
    TIM_DIER(TIM2_BASE) = TIM_DIER_CC1IE;
}

/* All four pins are low, and so is DIR. */
void stm32_step_start(bool may_move)
{
    stm32_enable_clock(&RCC_APB1ENR, RCC_APB1ENR_TIM2EN);
    stm32_step_make_safe();
    stm32_gpio.may_move = may_move;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        struct stm32_gpio_channel *channel = &stm32_gpio.channel[motor];
        *channel = (struct stm32_gpio_channel){
            .pin = &GPIO_BSRR(step_pins[motor] / 16U),
            .low_bits = bits_of(motor, false),
            .direction = &GPIO_BSRR(direction_pins[motor] / 16U),
        };
        stm32_enable_clock(&RCC_AHB1ENR, RCC_AHB1ENR_GPIOAEN << (direction_pins[motor] / 16U));
        connect(channel, motor, may_move);
        *channel->direction = stm32_gpio_direction_bits(motor);
    }
    start_timer();
}

static void start_refill(void)
{
    uint32_t place = REFILL_IRQ % 4U * 8U;
    uint32_t others = NVIC_IPR(REFILL_IRQ / 4U) & ~(0xFFU << place);
    stm32_vectors[EXCEPTIONS + REFILL_IRQ] = (uint32_t)(uintptr_t)stm32_step_refill_interrupt;
    NVIC_IPR(REFILL_IRQ / 4U) = others | (uint32_t)STM32_PRIORITY_LINE << (place + PRIORITY_PLACE);
    NVIC_ISER(REFILL_IRQ / 32U) = UINT32_C(1) << REFILL_IRQ % 32U;
}

/* The interrupt of the edges is let through next; it calls the refill, and that comes every millisecond from then on.
 */
void stm32_step_set_client(const struct hal_client *client)
{
    stm32_gpio.client = *client;
    start_refill();
    TIM_EGR(TIM2_BASE) = TIM_EGR_CC1G;
}

/* Also before stm32_step_start. */
void stm32_step_make_safe(void)
{
    uint32_t ports = 0;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        ports |= RCC_AHB1ENR_GPIOAEN << (step_pins[motor] / 16U);
    }
    stm32_enable_clock(&RCC_AHB1ENR, ports);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        GPIO_BSRR(step_pins[motor] / 16U) = bits_of(motor, false);
    }
}

bool stm32_step_is_stuck(void)
{
    bool stuck = false;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        const struct stm32_gpio_channel *channel = &stm32_gpio.channel[motor];
        uint32_t mask = stm32_mask();
        int32_t edge = channel->pending ? (int32_t)(TIM2_CNT - channel->edge_tick) : 0;
        int32_t refill = channel->active ? (int32_t)(TIM2_CNT - channel->due_tick) : 0;
        stm32_unmask(mask);
        stuck = stuck || edge > (int32_t)STUCK_TICKS || refill > (int32_t)STUCK_TICKS;
    }
    return stuck;
}

bool stm32_step_is_quiet(void)
{
    bool quiet = true;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        quiet = quiet && !stm32_gpio.channel[motor].active && !stm32_gpio.channel[motor].high;
    }
    return quiet;
}

bool hal_board_steps_are_timed(void)
{
    return false;
}
