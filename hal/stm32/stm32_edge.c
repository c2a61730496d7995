#include "stm32_edge.h"

#include "base_limits.h"
#include "stm32_private.h"

#define INPUT_LINES STM32_EDGE_INPUTS
#define INPUT_IRQS_0 STM32_EDGE_IRQS_0(INPUT_LINES)
#define INPUT_IRQS_1 STM32_EDGE_IRQS_1(INPUT_LINES)

/* Inputs, then the receiver. Of pins with the same line the first one has it. */
static const uint8_t pins[UNIT_INPUTS + 1U] = {
    STM32_PIN_BI_1, STM32_PIN_BI_2, STM32_PIN_BI_3, STM32_PIN_BI_4,    STM32_PIN_BI_5,
    STM32_PIN_BI_6, STM32_PIN_BI_7, STM32_PIN_BI_8, STM32_PIN_LINE_RX,
};

/* Lines 0 to 4 have interrupts of their own. */
uint32_t stm32_edge_irq(unsigned input)
{
    unsigned line = pins[input] % 16U;
    if (line <= EXTI4_IRQ - EXTI0_IRQ) {
        return EXTI0_IRQ + line;
    }
    return line < 10U ? EXTI9_5_IRQ : EXTI15_10_IRQ;
}

static void connect_lines(void)
{
    for (unsigned i = sizeof pins; i-- > 0;) {
        uint32_t line = pins[i] % 16U;
        uint32_t place = 4U * (line % 4U);
        uint32_t others = SYSCFG_EXTICR(line / 4U) & ~(UINT32_C(0xF) << place);
        SYSCFG_EXTICR(line / 4U) = others | (uint32_t)(pins[i] / 16U) << place;
    }
}

void stm32_edge_start(void)
{
    connect_lines();
    EXTI_RTSR = INPUT_LINES | STM32_EDGE_SUPPLY;
    EXTI_FTSR = INPUT_LINES | STM32_EDGE_KEPT;
    stm32_edge_let_through();
}

/* What is pending is of edges that a look sees. The read ends when the writes have arrived: a look after it misses no
 * edge that finds the mask still there. */
void stm32_edge_let_through(void)
{
    EXTI_PR = INPUT_LINES;
    EXTI_IMR = INPUT_LINES | STM32_EDGE_KEPT;
    (void)EXTI_IMR;
}

/* Edges of several lines at once are one: the interrupts of the others are taken back, once the requests are gone. */
void stm32_edge_hold(void)
{
    EXTI_IMR = STM32_EDGE_KEPT;
    EXTI_PR = INPUT_LINES;
    (void)EXTI_PR;
    NVIC_ICPR(0) = INPUT_IRQS_0;
    NVIC_ICPR(1) = INPUT_IRQS_1;
}
