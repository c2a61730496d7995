/* A preloaded compare value comes into force with the update. */
#include "part.h"

int main(void)
{
    RCC_APB1ENR |= 1;
    settle();
    TIM_PSC(TIM2) = 15;
    TIM_ARR(TIM2) = 99;
    TIM_CCMR1(TIM2) = 1 << 3;
    TIM_CCR(TIM2, 1) = 30;
    TIM_EGR(TIM2) = 1;
    TIM_SR(TIM2) = 0;
    TIM_CR1(TIM2) = 1;
    TIM_CCR(TIM2, 1) = 60;
    while ((TIM_SR(TIM2) & 2) == 0) {
    }
    result[0] = TIM_CNT(TIM2); /* by the value before */
    TIM_SR(TIM2) = 0;
    while ((TIM_SR(TIM2) & 2) == 0) {
    }
    result[1] = TIM_CNT(TIM2); /* by the new one, one period later */
    return 0;
}
