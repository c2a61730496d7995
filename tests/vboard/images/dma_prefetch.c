/* A ring that is rewritten while its stream runs; the requests come by software, so that each can be waited for. */
#include "dma.h"

static volatile uint32_t ring[4] = {10, 20, 30, 40};

int main(void)
{
    switch_on();
    TIM_DIER(TIM2) = DIER_CC1DE;
    set_up(5, &TIM_CCR(TIM2, 2), ring, 4, CHSEL(3) | CR_WORDS);
    result[0] = DMA_NDTR(5);
    enable(5);
    wait_cycles(20);
    result[1] = DMA_NDTR(5); /* a word is in the FIFO, but none has been transferred */
    ring[0] = 11;            /* too late */
    ring[1] = 21;            /* in time */
    ask(EGR_CH1);
    result[2] = TIM_CCR(TIM2, 2);
    result[3] = DMA_NDTR(5);
    ring[1] = 22; /* too late */
    ring[2] = 31; /* in time */
    ask(EGR_CH1);
    result[4] = TIM_CCR(TIM2, 2);
    ask(EGR_CH1);
    result[5] = TIM_CCR(TIM2, 2);
    result[6] = DMA_NDTR(5);
    result[7] = flags_of(5);

    DMA_CR(5) &= ~(uint32_t)CR_EN; /* the word in the FIFO, 40, is lost */
    result[8] = DMA_CR(5) & CR_EN;
    while ((DMA_CR(5) & CR_EN) != 0) {
    }
    result[9] = flags_of(5);
    result[10] = DMA_NDTR(5);
    ring[3] = 41;
    ask(EGR_CH1); /* while no stream serves it, the request waits */
    result[11] = TIM_CCR(TIM2, 2);
    clear_flags(5);
    DMA_M0AR(5) = (uint32_t)&ring[3];
    DMA_NDTR(5) = 1;
    enable(5);
    wait_cycles(100);
    result[12] = TIM_CCR(TIM2, 2);
    result[13] = DMA_CR(5) & CR_EN;
    result[14] = DMA_NDTR(5);
    result[15] = flags_of(5);

    clear_flags(5); /* at its end NDTR is 0; enabled again, it is what it was written with */
    ring[3] = 42;
    enable(5);
    result[16] = DMA_NDTR(5);
    wait_cycles(20);
    ask(EGR_CH1);
    result[17] = TIM_CCR(TIM2, 2);
    result[18] = flags_of(5);
    return 0;
}
