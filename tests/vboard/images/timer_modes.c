/* Prescaler and period, and a compare value that the counter has passed already. */
#include "part.h"

int main(void)
{
    RCC_APB1ENR |= 3;
    settle();
    TIM_PSC(TIM2) = 15; /* 1 MHz */
    TIM_ARR(TIM2) = 99;
    TIM_EGR(TIM2) = 1; /* takes the prescaler over */
    result[0] = TIM_SR(TIM2);
    TIM_SR(TIM2) = 0;
    uint32_t before = cycles();
    TIM_CR1(TIM2) = 1;
    while ((TIM_SR(TIM2) & 1) == 0) {
    }
    result[1] = (cycles() - before) / 16; /* us of a period */
    TIM_CR1(TIM2) = 0;
    TIM_SR(TIM2) = 0;
    TIM_CNT(TIM2) = 50;
    TIM_CCR(TIM2, 1) = 40; /* passed: matches after the turn */
    TIM_SR(TIM2) = 0;
    before = cycles();
    TIM_CR1(TIM2) = 1;
    while ((TIM_SR(TIM2) & 2) == 0) {
    }
    result[2] = (cycles() - before) / 16;
    result[3] = TIM_CNT(TIM2);

    TIM_CNT(TIM3) = 0xFFFE;     /* 16 bits */
    TIM_CR1(TIM3) = 1 | 1 << 3; /* one pulse: stops at the update */
    __asm volatile("nop\n nop\n nop\n nop\n nop\n nop");
    result[4] = TIM_CR1(TIM3);
    result[5] = TIM_CNT(TIM3);
    result[6] = TIM_ARR(TIM3);
    return 0;
}
