#include "stm32_pins.h"

#include <assert.h>

#include "stm32_private.h"

/* Anything else would count as low in one place and as high in another. */
static_assert(BOARD_STEP_LEVEL <= 1U, "BOARD_STEP_LEVEL must be 1 (high) or 0 (low)");
static_assert(BOARD_DIR_LEVEL <= 1U, "BOARD_DIR_LEVEL must be 1 (high) or 0 (low)");
static_assert(BOARD_ENABLE_LEVEL <= 1U, "BOARD_ENABLE_LEVEL must be 1 (high) or 0 (low)");
static_assert(BOARD_BI_LEVEL <= 1U, "BOARD_BI_LEVEL must be 1 (high) or 0 (low)");
static_assert(BOARD_BO_LEVEL <= 1U, "BOARD_BO_LEVEL must be 1 (high) or 0 (low)");
static_assert(BOARD_LED_LEVEL <= 1U, "BOARD_LED_LEVEL must be 1 (high) or 0 (low)");
static_assert(BOARD_S1_LEVEL <= 1U, "BOARD_S1_LEVEL must be 1 (high) or 0 (low)");
#ifdef BOARD_PWM_PINS
static_assert(BOARD_PWM_LEVEL <= 1U, "BOARD_PWM_LEVEL must be 1 (high) or 0 (low)");
#endif

/* What a pin is for: its mode (RM0090 8.4.1), its pull-up, whether it makes steps, the number of its alternate function
 * (datasheet DS8626, table 9). Pins that make steps are medium fast: edges of slow ones may take 100 ns, a fifth of the
 * shortest pulse, those of medium fast ones 10 ns (DS8626, I/O AC characteristics, at 50 pF). */
enum {
    MODE_IN = 0,
    MODE_OUT = 1,
    MODE_ALTERNATE = 2,
    USE_PULL_UP = 1 << 2,
    USE_FAST = 1 << 3,
    USE_ALTERNATE_PLACE = 4,

    USE_IN = MODE_IN,
    USE_IN_UP = MODE_IN | USE_PULL_UP,
    USE_OUT = MODE_OUT,
    USE_GPIO = MODE_OUT | USE_FAST,
    USE_TIM2_CH1 = MODE_ALTERNATE | USE_FAST | 1 << USE_ALTERNATE_PLACE,
    USE_TIM2_CH2 = USE_TIM2_CH1,
    USE_TIM2_CH3 = USE_TIM2_CH1,
    USE_TIM3_CH1 = MODE_ALTERNATE | USE_FAST | 2 << USE_ALTERNATE_PLACE,
    USE_TIM3_CH2 = USE_TIM3_CH1,
    USE_TIM3_CH3 = USE_TIM3_CH1,
    USE_TIM3_CH4 = USE_TIM3_CH1,
    USE_TIM4_CH1 = USE_TIM3_CH1,
    USE_TIM4_CH2 = USE_TIM3_CH1,
    USE_TIM4_CH3 = USE_TIM3_CH1,
    USE_TIM4_CH4 = USE_TIM3_CH1,
    USE_TIM5_CH1 = MODE_ALTERNATE | USE_FAST | 2 << USE_ALTERNATE_PLACE,
    USE_TIM5_CH2 = USE_TIM5_CH1,
    USE_TIM5_CH3 = USE_TIM5_CH1,
    USE_TIM5_CH4 = USE_TIM5_CH1,
    USE_USART1 = MODE_ALTERNATE | 7 << USE_ALTERNATE_PLACE | USE_PULL_UP,
    USE_USART2 = USE_USART1,
    USE_USART3 = USE_USART1,
};

struct use {
    uint8_t pin;
    uint8_t use;
};

static const struct use uses[] = {
#define X(signal, port, pin, use) {(uint8_t)STM32_PIN_##signal, (uint8_t)USE_##use},
    BOARD_PINS(X) BOARD_ENABLE_PINS(X) STM32_PWM_PINS(X) STM32_MORE_LED_PINS(X)
#undef X
#define X(port, pin, what) {(uint8_t)(16 * STM32_PORT_##port + (pin)), (uint8_t)USE_IN_UP},
        BOARD_PULLED_UP(X)
#undef X
};

enum {
    USES = sizeof uses / sizeof uses[0]
};

static void set_field(volatile uint32_t *word, uint32_t place, uint32_t width, uint32_t value)
{
    uint32_t mask = ((UINT32_C(1) << width) - 1U) << place;
    *word = (*word & ~mask) | value << place;
}

/* The mode comes last, so that a pin does not show a level that is not meant for it. */
static void set_up(const struct use *use)
{
    uint32_t port = use->pin / 16U;
    uint32_t pin = use->pin % 16U;
    volatile uint32_t *alternate = pin < 8U ? &GPIO_AFRL(port) : &GPIO_AFRH(port);
    set_field(alternate, 4U * (pin % 8U), 4U, (uint32_t)use->use >> USE_ALTERNATE_PLACE);
    set_field(&GPIO_OSPEEDR(port), 2U * pin, 2U, (use->use & USE_FAST) != 0 ? 1U : 0U);
    set_field(&GPIO_PUPDR(port), 2U * pin, 2U, (use->use & USE_PULL_UP) != 0 ? 1U : 0U);
    set_field(&GPIO_MODER(port), 2U * pin, 2U, use->use & 3U);
}

/* The pin of the transmitter, or all others. */
static void set_up_all(bool sender)
{
    for (unsigned i = 0; i < USES; i++) {
        bool is_sender = uses[i].pin == (uint8_t)STM32_PIN_LINE_TX;
        if (!IMAGE_LINE_FULL_DUPLEX || is_sender == sender) {
            set_up(&uses[i]);
        }
    }
}

static void start_ports(void)
{
    uint32_t ports = 0;
    for (unsigned i = 0; i < USES; i++) {
        ports |= RCC_AHB1ENR_GPIOAEN << (uses[i].pin / 16U);
    }
    stm32_enable_clock(&RCC_AHB1ENR, ports);
}

static const uint8_t outputs[] = {
    STM32_PIN_BO_1, STM32_PIN_BO_2, STM32_PIN_BO_3, STM32_PIN_BO_4,
    STM32_PIN_BO_5, STM32_PIN_BO_6, STM32_PIN_BO_7, STM32_PIN_BO_8,
};
static const uint8_t leds[] = {STM32_LED_PINS};

void stm32_pins_make_safe(void)
{
    start_ports();
    stm32_pin_write(STM32_PIN_LINE_DE, false);
    stm32_driver_disable();
    for (unsigned i = 0; i < sizeof outputs; i++) {
        stm32_pin_write(outputs[i], BOARD_BO_LEVEL == 0U);
    }
}

/* The timers hold the STEP and DIR pins before they are handed over to them, see hal_board_init. */
void stm32_pins_start(void)
{
    stm32_pins_make_safe();
    for (unsigned i = 0; i < sizeof leds; i++) {
        stm32_pin_write(leds[i], BOARD_LED_LEVEL == 0U);
    }
    set_up_all(false);
}

void stm32_pins_start_sender(void)
{
    set_up_all(true);
}
