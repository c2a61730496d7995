/* Cycles of accesses to a timer on APB1 and to a port on AHB1, from RAM. */
#include "measure.h"
#include "part.h"

MEASURE(empty, ".ramcode, \"ax\"", "")
MEASURE(reads, ".ramcode, \"ax\"", HUNDRED("ldr r3, [r4]\n nop"))
MEASURE(writes, ".ramcode, \"ax\"", HUNDRED("str r6, [r4]\n nop\n nop\n nop\n nop"))
MEASURE(close_writes, ".ramcode, \"ax\"", HUNDRED("str r6, [r4]"))

int main(void)
{
    volatile uint32_t *counter = &DWT_CYCCNT;
    uint32_t *timer = (uint32_t *)&TIM_CCR(TIM2, 1);
    uint32_t *port = (uint32_t *)&GPIO_ODR(GPIOB);
    RCC_APB1ENR |= 1;
    RCC_AHB1ENR |= 2;
    settle();
    result[0] = reads(counter, timer) - empty(counter, timer);
    result[1] = writes(counter, timer) - empty(counter, timer);
    result[2] = close_writes(counter, timer) - empty(counter, timer);
    result[3] = reads(counter, port) - empty(counter, port);
    result[4] = close_writes(counter, port) - empty(counter, port);
    return 0;
}
