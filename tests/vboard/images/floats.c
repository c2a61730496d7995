/* Floating-point registers survive an interrupt that uses them, and the frame on the stack is the long one. */
#include "part.h"

static volatile uint32_t stack_seen;

void exti0_handler(void)
{
    uint32_t sp;
    __asm volatile("mov %0, sp" : "=r"(sp));
    stack_seen = sp;
    __asm volatile(".fpu fpv4-sp-d16\n vmov s0, %0\n vmov s15, %0" ::"r"(7));
}

int main(void)
{
    uint32_t low;
    uint32_t high;
    uint32_t sp;
    SCB_CPACR = 0xFu << 20;
    NVIC_ISER(0) = 1u << IRQ_EXTI0;
    NVIC_ISPR(0) = 1u << IRQ_EXTI0;
    __asm volatile("nop\n nop\n mov %0, sp" : "=r"(sp));
    result[0] = sp - stack_seen;
    __asm volatile(".fpu fpv4-sp-d16\n vmov s0, %2\n vmov s15, %3\n str %5, [%4]\n nop\n nop\n"
                   "vmov %0, s0\n vmov %1, s15"
                   : "=&r"(low), "=&r"(high)
                   : "r"(1111), "r"(2222), "r"(&NVIC_ISPR(0)), "r"(1u << IRQ_EXTI0));
    result[1] = low;
    result[2] = high;
    __asm volatile("mov %0, sp" : "=r"(sp));
    result[3] = sp - stack_seen;
    return 0;
}
