/* What makes a timer ask for a transfer (RM0090 sections 18.3.8, 18.4.2, 18.4.4, 18.4.6). Each step counts transfers.
 */
#include "dma.h"

static volatile uint32_t words[64];
static unsigned used;

static uint32_t served(unsigned stream)
{
    uint32_t now = sizeof words / 4 - DMA_NDTR(stream);
    uint32_t fresh = now - used;
    used = now;
    return fresh;
}

static void restart(unsigned stream)
{
    if ((DMA_CR(stream) & CR_EN) != 0) {
        DMA_CR(stream) &= ~(uint32_t)CR_EN;
        while ((DMA_CR(stream) & CR_EN) != 0) {
        }
    }
    set_up(stream, &TIM_CCR(TIM2, 2), words, sizeof words / 4, CHSEL(3) | CR_WORDS);
    enable(stream);
    wait_cycles(20);
    used = 0;
}

static void by_events(void)
{
    restart(5);
    ask(EGR_CH1);
    result[0] = served(5); /* not enabled */
    TIM_DIER(TIM2) = DIER_CC1DE;
    wait_cycles(100);
    result[1] = served(5); /* the flag from before asks for nothing */
    ask(EGR_CH1);
    result[2] = served(5);
    ask(1);
    result[3] = served(5); /* an update */
    TIM_CR2(TIM2) = 1 << 3;
    ask(EGR_CH1);
    result[4] = served(5); /* CCDS: by updates only */
    ask(1);
    result[5] = served(5);
    TIM_CR2(TIM2) = 0;
}

static void by_updates(void)
{
    TIM_DIER(TIM2) = DIER_UDE;
    restart(1);
    ask(1);
    result[6] = served(1);
    TIM_CR1(TIM2) = 1 << 2; /* URS: not by software */
    ask(1);
    result[7] = served(1);
    TIM_ARR(TIM2) = 50;
    TIM_CR1(TIM2) = 1 << 2 | 1 << 3 | 1; /* one turn */
    wait_cycles(500);
    result[8] = served(1);
    TIM_CR1(TIM2) = 0;
    TIM_ARR(TIM2) = 0xFFFFFFFF;
    TIM_DIER(TIM2) = 0;
}

/* Forced, with nothing at the pin, a match asks as well (section 18.3.7). */
static void by_match(void)
{
    TIM_CCMR1(TIM2) = 4 << 4;
    TIM_CCR(TIM2, 1) = 30;
    TIM_CNT(TIM2) = 0;
    TIM_DIER(TIM2) = DIER_CC1DE;
    restart(5);
    TIM_CR1(TIM2) = 1;
    wait_cycles(200);
    TIM_CR1(TIM2) = 0;
    result[9] = served(5);
}

/* While nobody serves it a request waits; a second one is lost in it, and it goes with its enable. */
static void waiting(void)
{
    DMA_CR(5) &= ~(uint32_t)CR_EN;
    wait_cycles(20);
    ask(EGR_CH1);
    ask(EGR_CH1);
    restart(5);
    result[10] = sizeof words / 4 - DMA_NDTR(5);
    DMA_CR(5) &= ~(uint32_t)CR_EN;
    wait_cycles(20);
    ask(EGR_CH1);
    TIM_DIER(TIM2) = 0;
    TIM_DIER(TIM2) = DIER_CC1DE;
    restart(5);
    result[11] = sizeof words / 4 - DMA_NDTR(5);
}

/* TIM2_CH2 and TIM2_CH4 are ORed for stream 6. */
static void ored(void)
{
    TIM_DIER(TIM2) = DIER_CC2DE | DIER_CC4DE;
    restart(6);
    ask(EGR_CH4);
    result[12] = served(6);
    restart(7);
#ifdef TWICE
    ask(EGR_CH4);
#endif
}

int main(void)
{
    switch_on();
    by_events();
    by_updates();
    by_match();
    waiting();
    ored();
    return 0;
}
