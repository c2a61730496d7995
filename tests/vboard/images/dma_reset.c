/* Registers of DMA1 after a reset, of the part and by RCC: any bit that is set where the manual has none. */
#include "dma.h"

static volatile uint32_t words[4];

static uint32_t look(void)
{
    uint32_t odd = DMA_LISR | DMA_HISR;
    for (unsigned i = 0; i < 8; i++) {
        odd |= DMA_CR(i) | DMA_NDTR(i) | DMA_PAR(i) | DMA_M0AR(i) | DMA_M1AR(i) | (DMA_FCR(i) ^ 0x21);
    }
    return odd;
}

int main(void)
{
    switch_on();
    result[0] = look();
    TIM_DIER(TIM2) = DIER_CC1DE;
    set_up(5, &TIM_CCR(TIM2, 2), words, 4, CHSEL(3) | CR_WORDS);
    DMA_M1AR(5) = 1;
    DMA_FCR(5) = FCR_DMDIS;
    enable(5);
    wait_cycles(50);
    ask(EGR_CH1);
    ask(EGR_CH1);
    result[1] = look();
    RCC_AHB1RSTR = 1u << 21;
    RCC_AHB1RSTR = 0;
    settle();
    result[2] = look();
    return 0;
}
