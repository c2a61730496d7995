/*
 * Which lines of EXTI notice edges, as bits of its registers: those of the inputs, that of the start bits at the
 * receiver of a half-duplex line, and that of the voltage detector. Main and interrupts.
 */
#ifndef STM32_EDGE_H
#define STM32_EDGE_H

#include "stm32_pins.h"
#include "stm32f4.h"

/* The line of a pin has its number, whatever the port (RM0090 12.2.5). Inputs that share one with another are looked at
 * every millisecond, and whenever another edge comes. */
#define STM32_EDGE_LINE(signal) (UINT32_C(1) << (STM32_PIN_##signal % 16))
#define STM32_EDGE_INPUTS                                                                                              \
    (STM32_EDGE_LINE(BI_1) | STM32_EDGE_LINE(BI_2) | STM32_EDGE_LINE(BI_3) | STM32_EDGE_LINE(BI_4) |                   \
     STM32_EDGE_LINE(BI_5) | STM32_EDGE_LINE(BI_6) | STM32_EDGE_LINE(BI_7) | STM32_EDGE_LINE(BI_8))

/* The interrupts of some lines, as bits of the two registers of the interrupt controller. */
#define STM32_EDGE_IRQS_0(lines) (((lines) & 0x1FU) << EXTI0_IRQ | (((lines) & 0x3E0U) != 0 ? 1U << EXTI9_5_IRQ : 0U))
#define STM32_EDGE_IRQS_1(lines) (((lines) & 0xFC00U) != 0 ? 1U << (EXTI15_10_IRQ - 32U) : 0U)

/* Start bits are only looked for in the pending register, which keeps an edge for certain if its line is not masked
 * (RM0090 12.2.5 and 12.3.6 can be read both ways). So their interrupt must be nobody else's, as it is never let
 * through. 0: an input has the line, or the interrupt. */
#define STM32_EDGE_START                                                                                               \
    ((STM32_EDGE_IRQS_0(STM32_EDGE_INPUTS) & STM32_EDGE_IRQS_0(STM32_EDGE_LINE(LINE_RX))) == 0 &&                      \
             (STM32_EDGE_IRQS_1(STM32_EDGE_INPUTS) & STM32_EDGE_IRQS_1(STM32_EDGE_LINE(LINE_RX))) == 0                 \
         ? STM32_EDGE_LINE(LINE_RX)                                                                                    \
         : 0U)

/* The voltage detector (RM0090 5.2.3), likewise. */
#define STM32_EDGE_SUPPLY 0x10000U
#define STM32_EDGE_KEPT (STM32_EDGE_START | STM32_EDGE_SUPPLY)

#endif
