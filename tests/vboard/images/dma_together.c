/*
 * Channels of TIM5 in toggle mode that match on the same ticks all the time, `distance` ticks apart, by streams 2, 4, 0
 * and 1: what NDTR has at the end tells whether every edge was written before its tick. FLOOD: the processor reads (1)
 * or writes (2) APB1 without a pause meanwhile.
 */
#include "dma.h"

#ifndef FLOOD
#define FLOOD 0
#endif

enum {
    EDGES = 32,
    FIRST = 2000
};

extern const uint32_t distance, channels;
const uint32_t distance __attribute__((section(".rodata.distance"))) = 42;
const uint32_t channels __attribute__((section(".rodata.channels"))) = 4;

static volatile uint32_t ring[EDGES];

/* From RAM, so that nothing but the bus is waited for: a read of the timer, or a write, after the other. */
RAMCODE static void use_the_bus(volatile uint32_t *status)
{
#if FLOOD == 1
    __asm volatile(".rept 100\n ldr r3, [%0]\n .endr" ::"r"(status) : "r3");
#elif FLOOD == 2
    __asm volatile("mvn r3, #0\n .rept 100\n str r3, [%0]\n .endr" ::"r"(status) : "r3");
#else
    (void)status;
#endif
}

int main(void)
{
    static const uint8_t streams[] = {2, 4, 0, 1};
    uint32_t step = *(const volatile uint32_t *)&distance;
    uint32_t count = *(const volatile uint32_t *)&channels;
    run_at_168_mhz();
    switch_on();
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~0xFFu) | 0xAA;
    GPIO_AFRL(GPIOA) = 0x2222;
    TIM_CCMR1(TIM5) = 3 << 4 | 3 << 12;
    TIM_CCMR2(TIM5) = 3 << 4 | 3 << 12;
    TIM_CCER(TIM5) = 0x1111;
    for (uint32_t i = 0; i < EDGES; i++) {
        ring[i] = FIRST + (i + 1) * step;
    }
    for (uint32_t i = 0; i < count; i++) {
        TIM_CCR(TIM5, 1 + i) = FIRST;
        set_up(streams[i], &TIM_CCR(TIM5, 1 + i), ring, EDGES, CHSEL(6) | CR_WORDS);
        enable(streams[i]);
    }
    TIM_DIER(TIM5) = ((1u << count) - 1) << 9;
    TIM_CR1(TIM5) = 1;
    for (uint32_t begin = cycles(); cycles() - begin < 2 * (FIRST + EDGES * step + 1000);) {
        use_the_bus(&TIM_SR(TIM5));
    }
    for (uint32_t i = 0; i < count; i++) {
        result[i] = DMA_NDTR(streams[i]);
    }
    return 0;
}
