#include "hal_io.h"

#include "base_limits.h"
#include "stm32_pins.h"
#include "stm32_private.h"

/* Whether the inputs are eight pins in a row of one port, which one look shows, all at the same moment. */
#define IN_A_ROW                                                                                                       \
    (STM32_PIN_BI_2 == STM32_PIN_BI_1 + 1 && STM32_PIN_BI_3 == STM32_PIN_BI_1 + 2 &&                                   \
     STM32_PIN_BI_4 == STM32_PIN_BI_1 + 3 && STM32_PIN_BI_5 == STM32_PIN_BI_1 + 4 &&                                   \
     STM32_PIN_BI_6 == STM32_PIN_BI_1 + 5 && STM32_PIN_BI_7 == STM32_PIN_BI_1 + 6 &&                                   \
     STM32_PIN_BI_8 == STM32_PIN_BI_1 + 7 && STM32_PIN_BI_1 / 16 == STM32_PIN_BI_8 / 16)

static const uint8_t input_pins[UNIT_INPUTS] = {
    STM32_PIN_BI_1, STM32_PIN_BI_2, STM32_PIN_BI_3, STM32_PIN_BI_4,
    STM32_PIN_BI_5, STM32_PIN_BI_6, STM32_PIN_BI_7, STM32_PIN_BI_8,
};
static const uint8_t output_pins[UNIT_OUTPUTS] = {
    STM32_PIN_BO_1, STM32_PIN_BO_2, STM32_PIN_BO_3, STM32_PIN_BO_4,
    STM32_PIN_BO_5, STM32_PIN_BO_6, STM32_PIN_BO_7, STM32_PIN_BO_8,
};
static const uint8_t led_pins[] = {STM32_LED_PINS};
static const uint8_t switch_pins[4] = {STM32_PIN_S1_1, STM32_PIN_S1_2, STM32_PIN_S1_3, STM32_PIN_S1_4};

/* All LEDs blink together: no crystal. What the unit says of them is not shown then. */
static bool blinking;

/* One pin after the other, within a microsecond. */
static uint32_t gather_levels(void)
{
    uint32_t levels = 0;
    for (unsigned i = 0; i < UNIT_INPUTS; i++) {
        levels |= stm32_pin_read(input_pins[i]) ? UINT32_C(1) << i : 0U;
    }
    return levels;
}

uint8_t hal_io_read_inputs(void)
{
    uint32_t levels = IN_A_ROW ? GPIO_IDR(STM32_PIN_BI_1 / 16U) >> (STM32_PIN_BI_1 % 16U) : gather_levels();
    return (uint8_t)(BOARD_BI_LEVEL == 1U ? levels : ~levels);
}

void hal_io_write_outputs(uint8_t levels)
{
    for (unsigned i = 0; i < UNIT_OUTPUTS; i++) {
        stm32_pin_write(output_pins[i], (levels >> i & 1U) == BOARD_BO_LEVEL);
    }
}

static void write_led(unsigned led, bool on)
{
    stm32_pin_write(led_pins[led], on == (BOARD_LED_LEVEL == 1U));
}

void hal_io_set_led(unsigned led, bool on)
{
    if (!blinking && led < sizeof led_pins) {
        write_led(led, on);
    }
}

void stm32_io_blink(bool on)
{
    blinking = true;
    for (unsigned led = 0; led < sizeof led_pins; led++) {
        write_led(led, on);
    }
}

uint8_t stm32_io_node(void)
{
    unsigned number = 0;
    for (unsigned i = 0; i < sizeof switch_pins; i++) {
        bool on = stm32_pin_read(switch_pins[i]) == (BOARD_S1_LEVEL == 1U);
        number |= on ? 1U << i : 0U;
    }
    return (uint8_t)(1U + number);
}
