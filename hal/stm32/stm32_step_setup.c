#include "hal_step.h"
#include "stm32_pins.h"
#include "stm32_step_private.h"

static const uint8_t direction_pins[UNIT_MOTORS] = {STM32_PIN_DIR_1, STM32_PIN_DIR_2, STM32_PIN_DIR_3, STM32_PIN_DIR_4};

static void write_direction(unsigned motor)
{
    const struct stm32_channel *channel = &stm32_step.channel[motor];
    bool high = channel->connected && channel->backward;
    stm32_pin_write(direction_pins[motor], high == (BOARD_DIR_LEVEL == 1U));
}

static void wait_until_past(uint32_t start, uint32_t ticks)
{
    while (TIM2_CNT - start < ticks) {
    }
}

/* Waits a few microseconds: what DIR has to stand still after the last pulse, and before the next. */
static void set_pins(unsigned motor, bool backward, bool connected)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    if (channel->backward == backward && channel->connected == connected) {
        return;
    }
    wait_until_past(edge_of(motor), HOLD_TICKS);
    channel->backward = backward;
    channel->connected = connected;
    write_direction(motor);
    wait_until_past(TIM2_CNT, SETUP_TICKS);
}

void hal_step_set_direction(unsigned motor, bool backward)
{
    set_pins(motor, backward, stm32_step.channel[motor].connected);
}

/* STEP is low at rest, connected or not: the next pulse is armed in the right mode. Without the crystal nothing is ever
 * connected. */
void hal_step_connect(unsigned motor, bool connected)
{
    set_pins(motor, stm32_step.channel[motor].backward, connected && stm32_step.may_move);
}

/* All four pins low and the counter running; the pins may be handed over to the timer now. */
void stm32_step_start(bool may_move)
{
    uint32_t levels = TIM2_CCER_CC1P | TIM2_CCER_CC2P | TIM2_CCER_CC3P | TIM2_CCER_CC4P;
    stm32_enable_clock(&RCC_APB1ENR, RCC_APB1ENR_TIM2EN);
    TIM2_CR1 = 0;
    TIM2_PSC = 0;
    TIM2_ARR = UINT32_MAX;
    TIM2_EGR = TIM2_EGR_UG;
    stm32_step.may_move = may_move;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        stm32_step.channel[motor] = (struct stm32_channel){
            .modes = &stm32_step.modes[motor / 2U],
            .mode = &TIM2_CCMR1 + motor / 2U,
            .compare = &TIM2_CCR1 + motor,
            .one = motor % 2U == 0 ? TIM2_CCMR1_OC1M(1U) : TIM2_CCMR1_OC2M(1U),
            .connected = may_move,
        };
        set_mode(&stm32_step.channel[motor], MODE_LOW);
    }
    TIM2_CCER =
        TIM2_CCER_CC1E | TIM2_CCER_CC2E | TIM2_CCER_CC3E | TIM2_CCER_CC4E | (BOARD_STEP_LEVEL == 1U ? 0U : levels);
    set_enabled(0, 0);
    TIM2_SR = 0;
    TIM2_CR1 = TIM2_CR1_CEN;
}

void stm32_step_set_client(const struct hal_client *client)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        stm32_step.client[motor] = client->channel[motor];
    }
}

/* Also before stm32_step_start. */
void stm32_step_make_safe(void)
{
    stm32_enable_clock(&RCC_APB1ENR, RCC_APB1ENR_TIM2EN);
    TIM2_DIER = 0;
    TIM2_CCMR1 = TIM2_CCMR1_OC1M((uint32_t)MODE_LOW) | TIM2_CCMR1_OC2M((uint32_t)MODE_LOW);
    TIM2_CCMR2 = TIM2_CCMR2_OC3M((uint32_t)MODE_LOW) | TIM2_CCMR2_OC4M((uint32_t)MODE_LOW);
}

bool stm32_step_is_stuck(void)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        uint32_t mask = stm32_mask();
        bool armed = (enabled() & flag_of(motor)) != 0;
        int32_t overdue = (int32_t)(TIM2_CNT - edge_of(motor));
        stm32_unmask(mask);
        if (armed && overdue > (int32_t)STUCK_TICKS) {
            return true;
        }
    }
    return false;
}
