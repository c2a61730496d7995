/* Edges by DMA with a period of 1000 ticks: 600 is written at 500 and comes at once, 400 is written at 600 and comes
 * only after the counter has turned. */
#include "dma.h"

static volatile uint32_t ring[3] = {600, 400, 450};

int main(void)
{
    run_at_168_mhz();
    switch_on();
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~3u) | 2;
    GPIO_AFRL(GPIOA) = 1;
    TIM_CCMR1(TIM2) = 3 << 4;
    TIM_CCER(TIM2) = 1;
    TIM_ARR(TIM2) = 999;
    TIM_CCR(TIM2, 1) = 500;
    set_up(5, &TIM_CCR(TIM2, 1), ring, 3, CHSEL(3) | CR_WORDS);
    enable(5);
    TIM_DIER(TIM2) = DIER_CC1DE;
    TIM_CR1(TIM2) = 1;
    wait_cycles(2 * 1900);
    result[0] = DMA_NDTR(5);
    return 0;
}
