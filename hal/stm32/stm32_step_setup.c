#include "hal_step.h"
#include "stm32_pins.h"
#include "stm32_step_private.h"

static const uint8_t direction_pins[UNIT_MOTORS] = {STM32_PIN_DIR_1, STM32_PIN_DIR_2, STM32_PIN_DIR_3, STM32_PIN_DIR_4};

static void write_direction(unsigned motor, bool connected)
{
    bool high = connected && stm32_step.channel[motor].backward;
    stm32_pin_write(direction_pins[motor], high == (BOARD_DIR_LEVEL == 1U));
}

static void wait_until_past(uint32_t start, uint32_t ticks)
{
    while (TIM2_CNT - start < ticks) {
    }
}

/* Waits a few microseconds: what DIR has to stand still behind the last pulse, and before the next. */
void hal_step_set_direction(unsigned motor, bool backward)
{
    struct stm32_channel *channel = &stm32_step.channel[motor];
    if (channel->backward == backward) {
        return;
    }
    wait_until_past(edge_of(motor), HOLD_TICKS);
    channel->backward = backward;
    write_direction(motor, stm32_step.connected);
    wait_until_past(TIM2_CNT, SETUP_TICKS);
}

static void write_directions(bool connected)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        write_direction(motor, connected);
    }
}

/* A pulse that is being made, or is about to be, ends as it began: whole, or not at all. Its interrupt arms the next
 * one in the right mode. */
static void write_mode(unsigned motor)
{
    uint32_t flag = flag_of(motor);
    uint32_t edge = edge_of(motor);
    bool armed = (enabled() & flag) != 0;
    if (armed && (int32_t)(edge - TIM2_CNT) <= (int32_t)WRITE_TICKS) {
        stm32_step.edge[motor] = edge;
        set_enabled(stm32_step.plain & ~flag, stm32_step.special | flag);
    } else {
        set_mode(&stm32_step.channel[motor], armed ? armed_mode(motor) : (uint32_t)MODE_LOW);
    }
}

static void write_all_modes(bool connected)
{
    uint32_t mask = stm32_mask();
    stm32_step.connected = connected;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        write_mode(motor);
    }
    stm32_unmask(mask);
}

/* DIR stands still around the pulses that come before and behind. Without the crystal nothing is ever connected. */
void hal_step_connect(bool connected)
{
    if (connected && stm32_step.may_move) {
        write_directions(true);
        wait_until_past(TIM2_CNT, SETUP_TICKS);
        write_all_modes(true);
    } else {
        write_all_modes(false);
        wait_until_past(TIM2_CNT, HOLD_TICKS);
        write_directions(false);
    }
}

/* All four pins low and the counter running; the pins may be handed over to the timer now. */
void stm32_step_start(bool may_move)
{
    uint32_t levels = TIM2_CCER_CC1P | TIM2_CCER_CC2P | TIM2_CCER_CC3P | TIM2_CCER_CC4P;
    RCC_APB1ENR |= RCC_APB1ENR_TIM2EN;
    (void)RCC_APB1ENR;
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
        };
    }
    write_all_modes(may_move);
    TIM2_CCER = TIM2_CCER_CC1E | TIM2_CCER_CC2E | TIM2_CCER_CC3E | TIM2_CCER_CC4E |
                (BOARD_STEP_LEVEL == 1U ? 0U : levels);
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
    RCC_APB1ENR |= RCC_APB1ENR_TIM2EN;
    (void)RCC_APB1ENR;
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
