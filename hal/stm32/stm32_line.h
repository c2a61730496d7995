/*
 * Which USART the board has its line on.
 */
#ifndef STM32_LINE_H
#define STM32_LINE_H

#include "board.h"
#include "stm32f4.h"

#if BOARD_USART == 1
#define STM32_LINE_BASE USART1_BASE
#define STM32_LINE_IRQ USART1_IRQ
#define STM32_LINE_CLOCK_ENABLE() stm32_enable_clock(&RCC_APB2ENR, RCC_APB2ENR_USART1EN)
#define STM32_LINE_CLOCK_HZ(clock) ((clock)->apb2_hz)
#elif BOARD_USART == 2
#define STM32_LINE_BASE USART2_BASE
#define STM32_LINE_IRQ USART2_IRQ
#define STM32_LINE_CLOCK_ENABLE() stm32_enable_clock(&RCC_APB1ENR, RCC_APB1ENR_USART2EN)
#define STM32_LINE_CLOCK_HZ(clock) ((clock)->apb1_hz)
#elif BOARD_USART == 3
#define STM32_LINE_BASE USART3_BASE
#define STM32_LINE_IRQ USART3_IRQ
#define STM32_LINE_CLOCK_ENABLE() stm32_enable_clock(&RCC_APB1ENR, RCC_APB1ENR_USART3EN)
#define STM32_LINE_CLOCK_HZ(clock) ((clock)->apb1_hz)
#else
#error "BOARD_USART must be 1, 2 or 3"
#endif

#endif
