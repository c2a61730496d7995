/* Priority groups: with two bits of group priority, 0x40 to 0x70 are one group, in which the lower value goes first. */
#include "part.h"

static volatile uint32_t order;

void exti0_handler(void)
{
    order = order << 4 | 1;
    NVIC_ISPR(0) = 1u << IRQ_EXTI1 | 1u << IRQ_EXTI2;
    __asm volatile("dsb\n nop");
    order = order << 4 | 2;
}

void exti1_handler(void)
{
    order = order << 4 | 3;
}

void exti2_handler(void)
{
    order = order << 4 | 4;
}

int main(void)
{
    SCB_AIRCR = 0x05FA0000 | 5 << 8;
    NVIC_IPR(IRQ_EXTI0) = 0x60;
    NVIC_IPR(IRQ_EXTI1) = 0x70;
    NVIC_IPR(IRQ_EXTI2) = 0x40;
    NVIC_ISER(0) = 7u << IRQ_EXTI0;
    NVIC_ISPR(0) = 1u << IRQ_EXTI0;
    __asm volatile("dsb\n nop");
    result[0] = order;
    result[1] = SCB_AIRCR;
    return 0;
}
