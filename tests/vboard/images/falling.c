/* The voltage detector, level 6, in a supply that changes: result[0] microseconds until it says "low", result[1] until
 * it says "good" again; result[2], result[3] what EXTI has pending then of each of its edges. */
#include "part.h"

#define PWR_CR REG(0x40007000)
#define PWR_CSR REG(0x40007004)
#define LINE (1u << 16)

static uint32_t wait_for(uint32_t level)
{
    while ((PWR_CSR & 4) != level) {
    }
    return cycles() / 16;
}

int main(void)
{
    RCC_APB1ENR |= 1u << 28;
    settle();
    PWR_CR = 1u << 4 | 6u << 5;
    while (cycles() < 16 * 200) {
    }
    EXTI_IMR = LINE;
    EXTI_RTSR = LINE;
    result[0] = wait_for(4);
    result[2] = EXTI_PR;
    EXTI_PR = LINE;
    result[4] = EXTI_PR;
    EXTI_RTSR = 0;
    EXTI_FTSR = LINE;
    result[1] = wait_for(0);
    result[3] = EXTI_PR;
    return 0;
}
