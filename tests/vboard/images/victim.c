/* Counts passes of main and ticks of a millisecond for 20 ticks; what goes wrong with it is asked for by options. */
#include "part.h"

volatile uint32_t guard = 5;

void systick_handler(void)
{
    result[2]++;
}

void hard_fault_handler(void)
{
    result[4] = SCB_CFSR;
    result[5]++;
    test_end();
}

__attribute__((noinline)) void work(void)
{
    result[1]++;
}

int main(void)
{
    result[0] = RCC_CSR;
    result[6] = *(volatile uint32_t *)0x2001F000u; /* nobody has written it */
    *(volatile uint32_t *)0x2001F000u = 0x1234;
    SYST_RVR = 15999;
    SYST_CSR = 7;
    while (result[2] < 20) {
        work();
        result[3] = guard;
    }
    return 0;
}
