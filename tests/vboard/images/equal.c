/* A compare value written while a slow counter stands on it. */
#include "part.h"

int main(void)
{
    RCC_APB1ENR |= 1;
    settle();
    TIM_PSC(TIM2) = 1599; /* 100 us */
    TIM_EGR(TIM2) = 1;
    TIM_SR(TIM2) = 0;
    TIM_CR1(TIM2) = 1;
    while (TIM_CNT(TIM2) != 5) {
    }
    TIM_CCR(TIM2, 1) = 5;
    result[0] = TIM_CNT(TIM2);
    result[1] = TIM_SR(TIM2) & 2;
    while (TIM_CNT(TIM2) != 7) {
    }
    result[2] = TIM_SR(TIM2) & 2;
    return 0;
}
