/*
 * The board's pins as numbers: 16 * port + pin, ports from A = 0.
 */
#ifndef STM32_PINS_H
#define STM32_PINS_H

#include <stdbool.h>
#include <stdint.h>

#include "board.h"
#include "image.h"
#include "stm32f4.h"

enum {
    STM32_PORT_A,
    STM32_PORT_B,
    STM32_PORT_C,
    STM32_PORT_D,
    STM32_PORT_E,
    STM32_PORT_F,
    STM32_PORT_G
};

/* A board without ENABLE outputs says nothing of them. */
#ifndef BOARD_ENABLE_PINS
#define BOARD_ENABLE_PINS(X)
#define BOARD_ENABLE_LEVEL 0U
#define BOARD_ENABLE_READY_US 0U
#define BOARD_ENABLE_IDLE_MS 0U
#endif

/* What only some boards have, and only some units need: a PWM output, and more than four LEDs. */
#if IMAGE_PWM && defined BOARD_PWM_PINS
#define STM32_PWM_PINS(X) BOARD_PWM_PINS(X)
#define STM32_PWM_LEVEL BOARD_PWM_LEVEL
#else
#define STM32_PWM_PINS(X)
#define STM32_PWM_LEVEL 1U
#endif
#if IMAGE_LEDS > 4 && defined BOARD_MORE_LED_PINS
#define STM32_MORE_LED_PINS(X) BOARD_MORE_LED_PINS(X)
#else
#define STM32_MORE_LED_PINS(X)
#endif

/* All LEDs that the unit has, for a list. */
#define STM32_LED_PIN(signal, port, pin, use) STM32_PIN_##signal,
#define STM32_LED_PINS                                                                                                 \
    STM32_PIN_LED_1, STM32_PIN_LED_2, STM32_PIN_LED_3, STM32_PIN_LED_4, STM32_MORE_LED_PINS(STM32_LED_PIN)

enum stm32_pin {
#define X(signal, port, pin, use) STM32_PIN_##signal = 16 * STM32_PORT_##port + (pin),
    BOARD_PINS(X) BOARD_ENABLE_PINS(X) STM32_PWM_PINS(X) STM32_MORE_LED_PINS(X)
#undef X
};

static inline void stm32_pin_write(unsigned pin, bool high)
{
    GPIO_BSRR(pin / 16U) = UINT32_C(1) << (pin % 16U + (high ? 0U : 16U));
}

static inline bool stm32_pin_read(unsigned pin)
{
    return (GPIO_IDR(pin / 16U) >> (pin % 16U) & 1U) != 0;
}

#endif
