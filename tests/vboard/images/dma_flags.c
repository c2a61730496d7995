/* Flags, interrupt lines and errors of the streams; the requests come by software. */
#include "dma.h"

enum {
    CCM = 0x10000000,
    PORT = 0x40020014, /* ODR of port A, which is on AHB1 */
};

static volatile uint32_t words[4] = {1, 2, 3, 4};

#define HANDLER(stream)                                                                                                \
    void dma1_stream##stream##_handler(void)                                                                           \
    {                                                                                                                  \
        result[stream] = flags_of(stream);                                                                             \
        clear_flags(stream);                                                                                           \
        (void)flags_of(stream);                                                                                        \
    }
HANDLER(0)
HANDLER(1)
HANDLER(2)
HANDLER(3)
HANDLER(4)
HANDLER(5)
HANDLER(6)
HANDLER(7)

/* Each stream with a channel that a timer has: a word that the memory port cannot reach. */
static void fail_everywhere(void)
{
    static const uint8_t channel[] = {2, 3, 5, 2, 5, 3, 3, 3};
    for (unsigned i = 0; i < 8; i++) {
        set_up(i, &TIM_CCR(TIM2, 1), (uint32_t *)CCM, 1, CHSEL(channel[i]) | CR_WORDS | CR_TEIE);
        enable(i);
        wait_cycles(20);
        result[8] |= (DMA_CR(i) & CR_EN) << i;
    }
}

static void count_to_the_end(void)
{
    set_up(5, &TIM_CCR(TIM2, 2), words, 3, CHSEL(3) | CR_WORDS);
    enable(5);
    for (unsigned i = 0; i < 4; i++) {
        wait_cycles(20);
        result[9] = result[9] << 8 | flags_of(5);
        ask(EGR_CH1);
    }
    result[10] = DMA_CR(5) & CR_EN;
    result[11] = DMA_NDTR(5);
    result[12] = TIM_CCR(TIM2, 2);
    TIM_DIER(TIM2) = 0; /* the fourth request is taken back */
    TIM_DIER(TIM2) = DIER_CC1DE;
}

static void go_round(void)
{
    set_up(5, &TIM_CCR(TIM2, 2), words, 2, CHSEL(3) | CR_WORDS | CR_CIRC);
    enable(5);
    wait_cycles(20);
    ask(EGR_CH1);
    ask(EGR_CH1);
    result[13] = flags_of(5);
    result[14] = DMA_NDTR(5);
    ask(EGR_CH1);
    result[15] = TIM_CCR(TIM2, 2);
    result[16] = DMA_CR(5) & CR_EN;
    DMA_CR(5) &= ~(uint32_t)CR_EN;
    wait_cycles(20);
}

/* A request that is there before the first word. */
static void run_empty(void)
{
    set_up(5, &TIM_CCR(TIM2, 2), words + 3, 1, CHSEL(3) | CR_WORDS);
    DMA_FCR(5) |= FCR_FEIE;
    TIM_CCR(TIM2, 2) = 0;
    ask(EGR_CH1);
    result[5] = 0;
    enable(5);
    wait_cycles(100);
    result[17] = result[5];
    result[18] = TIM_CCR(TIM2, 2);
    DMA_FCR(5) &= ~(uint32_t)FCR_FEIE;
}

static void miss_the_bus(void)
{
    set_up(5, (uint32_t *)PORT, words, 2, CHSEL(3) | CR_WORDS);
    enable(5);
    wait_cycles(20);
    result[20] = DMA_CR(5) & CR_EN;
    ask(EGR_CH1);
    result[21] = DMA_CR(5) & CR_EN;
    result[22] = flags_of(5);
    result[23] = DMA_NDTR(5);
}

static void interrupt_late(void)
{
    set_up(5, &TIM_CCR(TIM2, 2), words, 1, CHSEL(3) | CR_WORDS);
    enable(5);
    wait_cycles(20);
    ask(EGR_CH1);
    result[5] = 0;
    DMA_CR(5) |= CR_TCIE; /* the flag is there already (section 10.4) */
    wait_cycles(20);
    result[24] = result[5];
}

int main(void)
{
    switch_on();
    NVIC_ISER(0) = 0x7Fu << 11;
    NVIC_ISER(1) = 1u << (47 - 32);
    TIM_DIER(TIM2) = DIER_CC1DE;
    fail_everywhere();
    count_to_the_end();
    go_round();
    run_empty();
    miss_the_bus();
    interrupt_late();
    return 0;
}
