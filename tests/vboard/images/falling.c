/* The voltage detector, level 6, in a supply that changes: result[0] microseconds until it says "low", result[1] until
 * it says "good" again. */
#include "part.h"

#define PWR_CR REG(0x40007000)
#define PWR_CSR REG(0x40007004)

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
    result[0] = wait_for(4);
    result[1] = wait_for(0);
    return 0;
}
