/* SysTick every 1000 cycles: its exceptions against the cycle counter. */
#include "part.h"

static volatile uint32_t count;
static volatile uint32_t seen[8];

void systick_handler(void)
{
    if (count < 8) {
        seen[count] = cycles();
    }
    count++;
}

int main(void)
{
    SYST_RVR = 999;
    SYST_CVR = 0;
    SYST_CSR = 7;
    while (count < 8) {
        __asm volatile("wfi");
    }
    SYST_CSR = 0;
    result[0] = seen[7] - seen[6];
    result[1] = seen[7] - seen[1];
    SYST_RVR = 99;
    SYST_CVR = 0;
    SYST_CSR = 5;
    while ((SYST_CSR & 1u << 16) == 0) {
    }
    result[2] = (SYST_CSR & 1u << 16) != 0; /* reading has cleared it, and 100 cycles are not over */
    SYST_CSR = 0;
    SYST_RVR = 999;
    SYST_CVR = 0;
    SYST_CSR = 1; /* HCLK / 8 */
    uint32_t before = cycles();
    while ((SYST_CSR & 1u << 16) == 0) {
    }
    result[3] = cycles() - before;
    return 0;
}
