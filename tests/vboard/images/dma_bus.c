/* At 168 MHz, from RAM: what a read of APB1 takes shortly after a request that makes a stream write there. */
#include "dma.h"
#include "measure.h"

/* r4 is TIM_EGR of TIM2; one more read, so that nothing is on its way before. */
MEASURE(read_after, ".ramcode, \"ax\"",
        "ldr r3, [r4]\n movs r6, #2\n str r6, [r4]\n .rept 12\n nop\n .endr\n ldr r3, [r4, #8]\n")

static volatile uint32_t words[2];

int main(void)
{
    uint32_t *egr = (uint32_t *)&TIM_EGR(TIM2);
    run_at_168_mhz();
    switch_on();
    TIM_DIER(TIM2) = DIER_CC1DE;
    result[0] = read_after(&DWT_CYCCNT, egr); /* nobody serves the request */
    TIM_DIER(TIM2) = 0;
    TIM_DIER(TIM2) = DIER_CC1DE;
    set_up(5, &TIM_CCR(TIM2, 2), words, 2, CHSEL(3) | CR_WORDS);
    enable(5);
    wait_cycles(20);
    result[1] = read_after(&DWT_CYCCNT, egr);
    result[2] = DMA_NDTR(5);
    return 0;
}
