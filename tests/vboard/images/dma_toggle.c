/* OCxREF of TIM2_CH1 while its mode changes (RM0090 sections 18.3.7, 18.3.8 and 18.4.7); matches by the counter, step
 * by step. */
#include "dma.h"

enum {
    FROZEN,
    TOGGLE = 3,
    LOW,
    HIGH
};

static uint32_t level(void)
{
    (void)TIM_CCMR1(TIM2);
    return GPIO_IDR(GPIOA) & 1;
}

static void match(void)
{
    TIM_CNT(TIM2) = 0;
    TIM_CCR(TIM2, 1) = 5;
    TIM_CR1(TIM2) = 1;
    wait_cycles(200);
    TIM_CR1(TIM2) = 0;
}

static uint32_t set_mode(uint32_t mode)
{
    TIM_CCMR1(TIM2) = mode << 4;
    return level();
}

int main(void)
{
    switch_on();
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~3u) | 2;
    GPIO_AFRL(GPIOA) = 1;
    TIM_CCER(TIM2) = 1;
    result[0] = set_mode(TOGGLE);
    match();
    result[1] = level();
    result[2] = set_mode(FROZEN);
    match();
    result[3] = level();
    result[4] = set_mode(TOGGLE);
    match();
    result[5] = level();
    result[6] = set_mode(HIGH);
    match();
    result[7] = level();
    result[8] = set_mode(TOGGLE);
    match();
    result[9] = level();
    match();
    result[10] = set_mode(LOW);
    result[11] = set_mode(TOGGLE);
    match();
    result[12] = level();
    return 0;
}
