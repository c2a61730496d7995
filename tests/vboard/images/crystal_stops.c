/* Runs from the crystal until it stops; the NMI of the clock security system notes what is left. */
#include "part.h"

void nmi_handler(void)
{
    result[0] = (RCC_CIR & 1u << 7) != 0;
    RCC_CIR |= 1u << 23;
    result[1] = RCC_CFGR >> 2 & 3;
    test_end();
}

int main(void)
{
    run_at_168_mhz();
#ifndef WITHOUT_CSS
    RCC_CR |= 1u << 19;
#endif
    for (;;) {
    }
}
