/* WFE with and without an event, sleep on exit, WFI with interrupts off. */
#include "part.h"

static volatile uint32_t ticks;

void systick_handler(void)
{
    ticks++;
    if (ticks == 10) {
        SCB_SCR = 0;
    }
}

static void start(uint32_t period)
{
    SYST_RVR = period - 1;
    SYST_CVR = 0;
    SYST_CSR = 7;
}

int main(void)
{
    __asm volatile("sev\n wfe"); /* the event is there already */
    start(1000);
    uint32_t before = cycles();
    __asm volatile("wfe");
    result[0] = ticks;
    result[1] = cycles() - before;

    ticks = 0;
    SCB_SCR = 2; /* sleep on exit: comes back when the handler says so */
    __asm volatile("wfi");
    result[2] = ticks;

    __asm volatile("cpsid i");
    ticks = 0;
    __asm volatile("wfi"); /* wakes, but takes no interrupt */
    result[3] = ticks;
    __asm volatile("cpsie i\n nop");
    result[4] = ticks;
    return 0;
}
