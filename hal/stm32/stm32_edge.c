#include "base_limits.h"
#include "stm32_pins.h"
#include "stm32_private.h"
#include "stm32f4.h"

/* The line of a pin has its number, whatever the port: tools/checks/board_pins.py refuses inputs that share one. */
enum {
    INPUT_PORT = STM32_PIN_BI_1 / 16,
    INPUT_FIRST = STM32_PIN_BI_1 % 16
};

#define INPUT_LINES (((UINT32_C(1) << UNIT_INPUTS) - 1U) << INPUT_FIRST)

/* Their interrupts, as bits of the two registers of the interrupt controller. */
#define INPUT_IRQS_0 ((INPUT_LINES & 0x1FU) << EXTI0_IRQ | ((INPUT_LINES & 0x3E0U) != 0 ? 1U << EXTI9_5_IRQ : 0U))
#define INPUT_IRQS_1 ((INPUT_LINES & 0xFC00U) != 0 ? 1U << (EXTI15_10_IRQ - 32U) : 0U)

/* Lines 0 to 4 have interrupts of their own. */
uint32_t stm32_edge_irq(unsigned input)
{
    unsigned line = INPUT_FIRST + input;
    if (line <= EXTI4_IRQ - EXTI0_IRQ) {
        return EXTI0_IRQ + line;
    }
    return line < 10U ? EXTI9_5_IRQ : EXTI15_10_IRQ;
}

void stm32_edge_start(void)
{
    stm32_enable_clock(&RCC_APB2ENR, RCC_APB2ENR_SYSCFGEN);
    for (unsigned line = INPUT_FIRST; line < INPUT_FIRST + UNIT_INPUTS; line++) {
        uint32_t place = 4U * (line % 4U);
        uint32_t others = SYSCFG_EXTICR(line / 4U) & ~(UINT32_C(0xF) << place);
        SYSCFG_EXTICR(line / 4U) = others | (uint32_t)INPUT_PORT << place;
    }
    EXTI_RTSR = INPUT_LINES;
    EXTI_FTSR = INPUT_LINES;
    stm32_edge_let_through();
}

/* What is pending is of edges that a look sees. The read ends when the writes have arrived: a look after it misses no
 * edge that finds the mask still there. */
void stm32_edge_let_through(void)
{
    EXTI_PR = INPUT_LINES;
    EXTI_IMR = INPUT_LINES;
    (void)EXTI_IMR;
}

/* Edges of several lines at once are one: the interrupts of the others are taken back, once the requests are gone. */
void stm32_edge_hold(void)
{
    EXTI_IMR = 0;
    EXTI_PR = INPUT_LINES;
    (void)EXTI_PR;
    NVIC_ICPR(0) = INPUT_IRQS_0;
    NVIC_ICPR(1) = INPUT_IRQS_1;
}
