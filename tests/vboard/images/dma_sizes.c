/* Half-words, and the FIFO: TIM3, whose registers have 16 bits, by stream 4, channel 5. */
#include "dma.h"

static volatile uint32_t words[6] = {0x00020001, 0x00040003, 0x00060005, 0x00080007, 0x000A0009, 0x000C000B};

static void ask_timer3(void)
{
    TIM_EGR(TIM3) = EGR_CH1;
    wait_cycles(100);
}

static uint32_t fifo_status(void)
{
    return DMA_FCR(4) >> 3 & 7;
}

int main(void)
{
    switch_on();
    TIM_DIER(TIM3) = DIER_CC1DE;
    set_up(4, &TIM_CCR(TIM3, 2), words, 3,
           CHSEL(5) | CR_TO_PERIPHERAL | CR_MINC | CR_PSIZE_HALF | CR_MSIZE_WORD | 1u << 21 | 1u << 15);
    enable(4);
    result[0] = DMA_CR(4); /* direct mode: MSIZE as PSIZE, no bursts, no offset */
    wait_cycles(20);
    ask_timer3();
    result[1] = TIM_CCR(TIM3, 2);
    ask_timer3();
    result[2] = TIM_CCR(TIM3, 2);
    ask_timer3();
    result[3] = TIM_CCR(TIM3, 2);

    clear_flags(4); /* the FIFO, refilled when half of it or less is left */
    DMA_FCR(4) = FCR_DMDIS | 1;
    DMA_NDTR(4) = 12;
    DMA_CR(4) = CHSEL(5) | CR_TO_PERIPHERAL | CR_MINC | CR_PSIZE_HALF | CR_MSIZE_WORD;
    result[4] = fifo_status();
    enable(4);
    wait_cycles(50);
    result[5] = fifo_status();
    words[3] = 0; /* too late: all four words are in the FIFO */
    words[4] = 0x00AA0099;
    for (unsigned i = 0; i < 12; i++) {
        ask_timer3();
        result[6 + i] = TIM_CCR(TIM3, 2) << 8 | fifo_status();
        if (i == 3) {
            words[4] = 0x00BB0099; /* too late */
        }
    }
    result[18] = flags_of(4);
    return 0;
}
