/*
 * Takes PLACE, a word of garbage, from the stack as the place to go on at, in main and in a handler: the fault is
 * noted, and the function that has lost its way returns.
 */
#include "part.h"

enum {
    INVPC = 1 << 18
};

static volatile uint32_t number;

/* Of the frame of a fault: note it, and let the call of lose_the_way return. */
static void note(uint32_t *frame)
{
    volatile uint32_t *noted = &result[8 * number++];
    noted[0] = SCB_ICSR & 0x1FF;
    noted[1] = SCB_CFSR;
    noted[2] = SCB_HFSR;
    noted[3] = frame[6];
    if ((noted[1] & INVPC) != 0) {
        test_end(); /* LR is what could not be returned by */
    }
    SCB_CFSR = SCB_CFSR;
    SCB_HFSR = SCB_HFSR;
    frame[6] = frame[5] & ~1u; /* what LR holds */
    frame[7] = (frame[7] & ~0x0600FC00u) | 1u << 24;
}

__attribute__((naked)) void hard_fault_handler(void)
{
    __asm volatile("mov r0, sp\n b %0" ::"i"(note));
}

/* POP {pc}; LR stays as the call has set it. */
__attribute__((naked, noinline)) static void lose_the_way(uint32_t place __attribute__((unused)))
{
    __asm volatile("push {r0}\n pop {pc}");
}

void systick_handler(void)
{
    SYST_CSR = 0;
    lose_the_way(PLACE);
    result[16]++;
}

int main(void)
{
    lose_the_way(PLACE);
    result[17]++;
    SYST_RVR = 1599;
    SYST_CSR = 7;
    while (result[16] == 0) {
    }
    result[18]++;
    return 0;
}
