#include "base_limits.h"
#include "stm32_pins.h"
#include "stm32_private.h"
#include "stm32f4.h"

/* The line of a pin has its number, whatever the port (RM0090 12.2.5). Of inputs that share one the first has it; the
 * others are looked at every millisecond, and whenever another edge comes. */
#define LINE_OF(input) (UINT32_C(1) << (STM32_PIN_BI_##input % 16))
#define INPUT_LINES                                                                                                    \
    (LINE_OF(1) | LINE_OF(2) | LINE_OF(3) | LINE_OF(4) | LINE_OF(5) | LINE_OF(6) | LINE_OF(7) | LINE_OF(8))

/* Their interrupts, as bits of the two registers of the interrupt controller. */
#define INPUT_IRQS_0 ((INPUT_LINES & 0x1FU) << EXTI0_IRQ | ((INPUT_LINES & 0x3E0U) != 0 ? 1U << EXTI9_5_IRQ : 0U))
#define INPUT_IRQS_1 ((INPUT_LINES & 0xFC00U) != 0 ? 1U << (EXTI15_10_IRQ - 32U) : 0U)

static const uint8_t pins[UNIT_INPUTS] = {
    STM32_PIN_BI_1, STM32_PIN_BI_2, STM32_PIN_BI_3, STM32_PIN_BI_4,
    STM32_PIN_BI_5, STM32_PIN_BI_6, STM32_PIN_BI_7, STM32_PIN_BI_8,
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

/* From the last to the first, which so wins. */
static void connect_lines(void)
{
    for (unsigned input = UNIT_INPUTS; input-- > 0;) {
        uint32_t line = pins[input] % 16U;
        uint32_t place = 4U * (line % 4U);
        uint32_t others = SYSCFG_EXTICR(line / 4U) & ~(UINT32_C(0xF) << place);
        SYSCFG_EXTICR(line / 4U) = others | (uint32_t)(pins[input] / 16U) << place;
    }
}

void stm32_edge_start(void)
{
    stm32_enable_clock(&RCC_APB2ENR, RCC_APB2ENR_SYSCFGEN);
    connect_lines();
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
