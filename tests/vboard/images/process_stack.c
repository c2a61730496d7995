/* Thread mode on the process stack: handlers run on the main one and return to the process stack. */
#include "part.h"

static uint32_t process_stack[64];
static uint32_t handler_sp;

void exti0_handler(void)
{
    __asm volatile("mov %0, sp" : "=r"(handler_sp));
}

int main(void)
{
    uint32_t msp;
    uint32_t sp;
    __asm volatile("mrs %0, msp" : "=r"(msp));
    NVIC_ISER(0) = 1u << IRQ_EXTI0;
    __asm volatile("msr psp, %[top]\n msr control, %[two]\n isb\n str %[bit], [%[pend]]\n nop\n nop\n"
                   "mov %[sp], sp\n msr control, %[zero]\n isb\n"
                   : [sp] "=&r"(sp)
                   : [top] "r"(process_stack + 64), [two] "r"(2), [pend] "r"(&NVIC_ISPR(0)), [bit] "r"(1u << IRQ_EXTI0),
                     [zero] "r"(0)
                   : "memory");
    result[0] = handler_sp > (uint32_t)(uintptr_t)(process_stack + 64) && handler_sp <= msp;
    result[1] = (uint32_t)(uintptr_t)(process_stack + 64);
    result[2] = sp;
    return 0;
}
