/* The clock tree: ready bits, and what a missing crystal looks like. result[0]: how the wait for the crystal ended. */
#include "part.h"

int main(void)
{
    result[1] = RCC_CR;
    result[2] = RCC_CSR;
    RCC_CR |= 1u << 16;
    uint32_t before = cycles();
    while ((RCC_CR & 1u << 17) == 0 && cycles() - before < 160000) { /* 10 ms at 16 MHz */
    }
    result[0] = (RCC_CR & 1u << 17) != 0;
    result[3] = cycles() - before;
    if (result[0] == 0) {
        RCC_CR &= ~(1u << 16);
        return 0;
    }
    run_at_168_mhz();
    result[4] = RCC_CFGR;
    return 0;
}
