/* Cycles of accesses at 168 MHz, from RAM: a timer on APB1 (a quarter of it), EXTI on APB2 (half), a port on AHB1. */
#include "measure.h"
#include "part.h"

MEASURE(empty, ".ramcode, \"ax\"", "")
MEASURE(reads, ".ramcode, \"ax\"", HUNDRED("ldr r3, [r4]\n nop"))
MEASURE(writes, ".ramcode, \"ax\"", HUNDRED("str r6, [r4]\n nop\n nop\n nop\n nop\n nop\n nop\n nop\n nop"))
MEASURE(close_writes, ".ramcode, \"ax\"", HUNDRED("str r6, [r4]"))
MEASURE(barriers, ".ramcode, \"ax\"", HUNDRED("str r6, [r4]\n dsb"))

int main(void)
{
    volatile uint32_t *counter = &DWT_CYCCNT;
    uint32_t *timer = (uint32_t *)&TIM_CCR(TIM2, 1);
    uint32_t *exti = (uint32_t *)&EXTI_RTSR;
    uint32_t *port = (uint32_t *)&GPIO_ODR(GPIOB);
    run_at_168_mhz();
    RCC_APB1ENR |= 1;
    RCC_AHB1ENR |= 2;
    settle();
    uint32_t nothing = empty(counter, timer);
    result[0] = reads(counter, timer) - nothing;
    result[1] = writes(counter, timer) - nothing;
    result[2] = close_writes(counter, timer) - nothing;
    result[3] = barriers(counter, timer) - nothing;
    result[4] = reads(counter, exti) - nothing;
    result[5] = close_writes(counter, exti) - nothing;
    result[6] = reads(counter, port) - nothing;
    result[7] = close_writes(counter, port) - nothing;
    return 0;
}
