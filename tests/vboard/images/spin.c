/* Compares 200 000 times a second on four channels for a while, and a main loop that works: the speed of emulation. */
#include "part.h"

static volatile uint32_t steps;
static volatile uint32_t work;

RAMCODE void tim2_handler(void)
{
    uint32_t flags = TIM_SR(TIM2);
    TIM_SR(TIM2) = ~flags;
    for (unsigned i = 1; i <= 4; i++) {
        if ((flags & 1u << i) != 0) {
            TIM_CCR(TIM2, i) += 420;
            steps++;
        }
    }
}

int main(void)
{
    run_at_168_mhz();
    RCC_APB1ENR |= 1;
    settle();
    for (unsigned i = 1; i <= 4; i++) {
        TIM_CCR(TIM2, i) = 1000 + 100 * i;
    }
    TIM_DIER(TIM2) = 0x1E;
    NVIC_ISER(0) = 1u << IRQ_TIM2;
    TIM_CR1(TIM2) = 1;
    while (steps < 40000) {
        work = work * 1664525 + 1013904223;
    }
    result[0] = steps;
    return 0;
}
