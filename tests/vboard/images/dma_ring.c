/*
 * A ring of 8 edges for TIM2_CH1 in toggle mode, by stream 5, channel 3: 40 pulses of 42 ticks, 84 ticks apart. The
 * interrupts of half and whole rings write the edges of the next round.
 */
#include "dma.h"

enum {
    RING = 8,
    PULSES = 40,
    FIRST = 1000,
    WIDTH = 42,
    PERIOD = 84,
    NEVER = 0xF0000000
};

static volatile uint32_t ring[RING];
static uint32_t next_edge = 1;

static uint32_t edge(uint32_t number)
{
    return number < 2 * PULSES ? FIRST + number / 2 * PERIOD + number % 2 * WIDTH : NEVER;
}

static void fill(uint32_t first)
{
    for (uint32_t i = first; i < first + RING / 2; i++) {
        ring[i] = edge(next_edge++);
    }
}

void dma1_stream5_handler(void)
{
    uint32_t flags = flags_of(5);
    clear_flags(5);
    result[0] += (flags & FLAG_HT) != 0;
    result[1] += (flags & FLAG_TC) != 0;
    result[2] |= flags;
    fill((flags & FLAG_HT) != 0 ? 0 : RING / 2);
    (void)flags_of(5);
}

int main(void)
{
    run_at_168_mhz();
    switch_on();
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~3u) | 2;
    GPIO_AFRL(GPIOA) = 1;
    TIM_CCMR1(TIM2) = 3 << 4;
    TIM_CCER(TIM2) = 1;
    TIM_CCR(TIM2, 1) = edge(0);
    fill(0);
    fill(RING / 2);
    set_up(5, &TIM_CCR(TIM2, 1), ring, RING, CHSEL(3) | CR_WORDS | CR_CIRC | CR_HTIE | CR_TCIE);
    enable(5);
    TIM_DIER(TIM2) = DIER_CC1DE;
    NVIC_ISER(0) = 1u << 16;
    TIM_CR1(TIM2) = 1;
    while (TIM_CNT(TIM2) < FIRST + PULSES * PERIOD) {
    }
    result[3] = DMA_NDTR(5);
    result[4] = DMA_CR(5) & CR_EN;
    result[5] = TIM_CCR(TIM2, 1);
    return 0;
}
