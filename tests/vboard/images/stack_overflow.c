/* The stack runs out of the bottom of SRAM; the handler of the fault sets up its own. */
#include "part.h"

__attribute__((naked)) void hard_fault_handler(void)
{
    __asm volatile("ldr r0, =0x20010000\n mov sp, r0\n b caught");
}

__attribute__((used)) static void caught(void)
{
    result[0] = SCB_CFSR;
    result[1] = SCB_HFSR;
    test_end();
}

int main(void)
{
    /* Not enough for the 32 bytes of a frame. */
    __asm volatile("cpsie i\n ldr r0, =0x20000010\n mov sp, r0\n svc #0");
    return 0;
}
