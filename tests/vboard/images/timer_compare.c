/* TIM2 at 84 MHz: channel 1 active on match at tick 1000, forced low, active again at 1500; channel 2 toggles. */
#include "part.h"

int main(void)
{
    run_at_168_mhz();
    RCC_AHB1ENR |= 1;
    RCC_APB1ENR |= 1;
    settle();
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~0xFu) | 0xA; /* PA0, PA1 alternate */
    GPIO_AFRL(GPIOA) = 0x11;                               /* TIM2 */
    TIM_CCR(TIM2, 1) = 1000;
    TIM_CCR(TIM2, 2) = 700;
    TIM_CCMR1(TIM2) = 1 << 4 | 3 << 12; /* active on match, toggle on match */
    TIM_CCER(TIM2) = 0x11;
    TIM_CR1(TIM2) = 1;
    while ((TIM_SR(TIM2) & 2) == 0) {
    }
    result[0] = TIM_CNT(TIM2);
    result[1] = TIM_SR(TIM2);
    TIM_SR(TIM2) = ~2u; /* writing 0 clears channel 1 only */
    result[2] = TIM_SR(TIM2);
    result[3] = GPIO_IDR(GPIOA) & 3;
    TIM_CCMR1(TIM2) = 4 << 4 | 3 << 12; /* forced inactive */
    (void)TIM_CCMR1(TIM2);              /* it has arrived: the port's bus is faster */
    result[4] = GPIO_IDR(GPIOA) & 3;
    TIM_CCMR1(TIM2) = 1 << 4 | 3 << 12;
    (void)TIM_CCMR1(TIM2);
    result[5] = GPIO_IDR(GPIOA) & 3; /* still low: no match since */
    TIM_CCR(TIM2, 1) = 1500;
    TIM_CCR(TIM2, 2) = 1600;
    while ((TIM_SR(TIM2) & 4) == 0 || (TIM_SR(TIM2) & 2) == 0 || TIM_CNT(TIM2) < 1700) {
    }
    result[6] = GPIO_IDR(GPIOA) & 3;
    return 0;
}
