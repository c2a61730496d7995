/* One fault after another; each handler notes the status and steps over the instruction. */
#include "part.h"

static volatile uint32_t number;

static void note(uint32_t *frame)
{
    result[3 * number] = SCB_ICSR & 0x1FF;
    result[3 * number + 1] = SCB_CFSR;
    result[3 * number + 2] = SCB_HFSR;
    number++;
    SCB_CFSR = SCB_CFSR;
    SCB_HFSR = SCB_HFSR;
    uint16_t code = *(volatile uint16_t *)(uintptr_t)frame[6];
    frame[6] += code >= 0xE800 ? 4 : 2;
}

__attribute__((naked)) void hard_fault_handler(void)
{
    __asm volatile("mov r0, sp\n b %0" ::"i"(note));
}

__attribute__((naked)) void bus_fault_handler(void)
{
    __asm volatile("mov r0, sp\n b %0" ::"i"(note));
}

__attribute__((naked)) void usage_fault_handler(void)
{
    __asm volatile("mov r0, sp\n b %0" ::"i"(note));
}

__attribute__((naked)) void svc_handler(void)
{
    __asm volatile("mov r0, #77\n str r0, [sp]\n bx lr");
}

static void provoke(void)
{
    (void)REG(0xA0000000); /* nothing is there */
    REG(0xA0000010) = 1;
    __asm volatile("udf #0");
    __asm volatile(".fpu fpv4-sp-d16\n vmov s0, r0"); /* the coprocessor is off */
}

int main(void)
{
    provoke(); /* no handler of their own is enabled: all go to HardFault */
    SCB_SHCSR = 7u << 16;
    provoke();
    result[24] = SCB_BFAR;
    register uint32_t r0 __asm("r0") = 0;
    __asm volatile("svc #3" : "+r"(r0));
    result[25] = r0;
    result[26] = number;
    SCB_CPACR = 0xFu << 20;
    __asm volatile(".fpu fpv4-sp-d16\n vmov s0, %0\n vmov r0, s0" ::"r"(1234) : "r0");
    result[27] = number;
    return 0;
}
