/* Sleeps between ticks of 1 ms. */
#include "part.h"

void systick_handler(void)
{
    result[0]++;
}

int main(void)
{
    run_at_168_mhz();
    SYST_RVR = 167999;
    SYST_CVR = 0;
    SYST_CSR = 7;
    for (;;) {
        __asm volatile("wfi");
    }
}
