/* Which stream is served first: two that are asked on the same cycle write the same register, and the later one is
 * seen. */
#include "dma.h"

static volatile uint32_t words[2] = {1, 5};

static uint32_t race(uint32_t level1, uint32_t level5)
{
    set_up(1, &TIM_CCR(TIM2, 2), &words[0], 1, CHSEL(3) | CR_WORDS | level1);
    set_up(5, &TIM_CCR(TIM2, 2), &words[1], 1, CHSEL(3) | CR_WORDS | level5);
    enable(1);
    enable(5);
    wait_cycles(20);
    ask(EGR_CH1 | EGR_CH3);
    return TIM_CCR(TIM2, 2);
}

int main(void)
{
    run_at_168_mhz();
    switch_on();
    TIM_DIER(TIM2) = DIER_CC1DE | DIER_CC3DE;
    result[0] = race(0, 0);
    result[1] = race(0, CR_PL_VERY_HIGH);
    result[2] = race(CR_PL_VERY_HIGH, CR_PL_VERY_HIGH);
    result[3] = race(CR_PL_VERY_HIGH, 2u << 16);
    return 0;
}
