/* A stream that is stopped while its transfer is on its way to the timer: at 168 MHz, where that takes a while. */
#include "dma.h"

static volatile uint32_t ring[4] = {10, 20, 30, 40};
static volatile uint32_t ready;

RAMCODE static void stop_at_once(void)
{
    volatile uint32_t *cr = &DMA_CR(5);
    uint32_t off = *cr & ~(uint32_t)CR_EN;
    TIM_EGR(TIM2) = EGR_CH1;
    __asm volatile("dsb"); /* it has arrived, and the stream has been asked */
    *cr = off;
    for (uint32_t i = 0; (*cr & CR_EN) != 0; i++) {
        result[0] = i + 1;
    }
}

int main(void)
{
    run_at_168_mhz();
    switch_on();
    TIM_DIER(TIM2) = DIER_CC1DE;
    set_up(5, &TIM_CCR(TIM2, 2), ring, 4, CHSEL(3) | CR_WORDS | CR_CIRC);
    enable(5);
    wait_cycles(20);
    stop_at_once();
    result[1] = flags_of(5);
    result[2] = DMA_NDTR(5);
    result[3] = TIM_CCR(TIM2, 2);
    return 0;
}
