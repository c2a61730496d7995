/*
 * Streams of DMA1 that write the registers of timers, from RM0090 chapter 10 alone.
 */
#ifndef DMA_H
#define DMA_H

#include "part.h"

enum {
    CR_EN = 1 << 0,
    CR_TEIE = 1 << 2,
    CR_HTIE = 1 << 3,
    CR_TCIE = 1 << 4,
    CR_TO_PERIPHERAL = 1 << 6,
    CR_CIRC = 1 << 8,
    CR_MINC = 1 << 10,
    CR_PSIZE_HALF = 1 << 11,
    CR_PSIZE_WORD = 2 << 11,
    CR_MSIZE_WORD = 2 << 13,
    CR_PL_VERY_HIGH = 3 << 16,
    CR_WORDS = CR_TO_PERIPHERAL | CR_MINC | CR_PSIZE_WORD | CR_MSIZE_WORD,
    FCR_DMDIS = 1 << 2,
    FCR_FEIE = 1 << 7,
    FLAG_FE = 1 << 0,
    FLAG_TE = 1 << 3,
    FLAG_HT = 1 << 4,
    FLAG_TC = 1 << 5,
    FLAGS = 0x3D,
    EGR_CH1 = 1 << 1, /* TIM_EGR, TIM_SR, TIM_DIER */
    EGR_CH3 = 1 << 3,
    EGR_CH4 = 1 << 4,
    DIER_UDE = 1 << 8,
    DIER_CC1DE = 1 << 9,
    DIER_CC2DE = 1 << 10,
    DIER_CC3DE = 1 << 11,
    DIER_CC4DE = 1 << 12,
};

#define CHSEL(channel) ((uint32_t)(channel) << 25)

static inline unsigned flag_shift(unsigned stream)
{
    return (stream & 1) * 6 + (stream & 2) * 8;
}

static inline uint32_t flags_of(unsigned stream)
{
    return (stream < 4 ? DMA_LISR : DMA_HISR) >> flag_shift(stream) & FLAGS;
}

static inline void clear_flags(unsigned stream)
{
    if (stream < 4) {
        DMA_LIFCR = FLAGS << flag_shift(stream);
    } else {
        DMA_HIFCR = FLAGS << flag_shift(stream);
    }
}

/* Everything but EN. */
static inline void set_up(unsigned stream, volatile uint32_t *target, const volatile uint32_t *from, uint32_t items,
                          uint32_t cr)
{
    clear_flags(stream);
    DMA_PAR(stream) = (uint32_t)target;
    DMA_M0AR(stream) = (uint32_t)from;
    DMA_NDTR(stream) = items;
    DMA_CR(stream) = cr;
}

static inline void enable(unsigned stream)
{
    DMA_CR(stream) |= CR_EN;
}

static inline void wait_cycles(uint32_t count)
{
    for (uint32_t begin = cycles(); cycles() - begin < count;) {
    }
}

/* One request of channel 1 of TIM2, by software, and the time that a transfer takes. */
static inline void ask(uint32_t events)
{
    TIM_EGR(TIM2) = events;
    wait_cycles(100);
}

static inline void switch_on(void)
{
    RCC_AHB1ENR |= 1u << 21 | 1;
    RCC_APB1ENR |= 1u << 3 | 3;
    settle();
}

#endif
