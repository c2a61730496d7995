/* Priorities, nesting, tail-chaining, BASEPRI and PRIMASK, by interrupts that software pends. */
#include "part.h"

static volatile uint32_t order;

static void note(uint32_t digit)
{
    order = order << 4 | digit;
}

void exti0_handler(void)
{
    note(1);
    NVIC_ISPR(0) = 1u << IRQ_EXTI1 | 1u << IRQ_EXTI2; /* one is more urgent, one is not */
    __asm volatile("dsb\n nop\n nop");
    result[8] = SCB_ICSR & 0x1FF;
    result[9] = NVIC_IABR(0);
    note(2);
}

void exti1_handler(void)
{
    note(3);
}

void exti2_handler(void)
{
    note(4);
}

static void set_basepri(uint32_t value)
{
    __asm volatile("msr basepri, %0" ::"r"(value) : "memory");
}

static void pend(uint32_t bits)
{
    NVIC_ISPR(0) = bits;
    __asm volatile("dsb\n nop\n nop" ::: "memory");
}

int main(void)
{
    NVIC_IPR(IRQ_EXTI0) = 0x40;
    NVIC_IPR(IRQ_EXTI1) = 0x20;
    NVIC_IPR(IRQ_EXTI2) = 0x60;
    NVIC_ISER(0) = 1u << IRQ_EXTI0 | 1u << IRQ_EXTI1 | 1u << IRQ_EXTI2;
    pend(1u << IRQ_EXTI0);
    result[0] = order; /* 1 3 2 4: nested by the urgent one, tail-chained to the other */

    order = 0;
    set_basepri(0x40); /* masks 0x40 and 0x60 */
    pend(1u << IRQ_EXTI2);
    result[1] = order;
    pend(1u << IRQ_EXTI1);
    result[2] = order;
    set_basepri(0);
    __asm volatile("nop");
    result[3] = order;

    order = 0;
    __asm volatile("cpsid i" ::: "memory");
    pend(1u << IRQ_EXTI1);
    result[4] = order;
    result[5] = NVIC_ISPR(0);
    NVIC_ICPR(0) = 1u << IRQ_EXTI1;
    __asm volatile("cpsie i\n nop" ::: "memory");
    result[6] = order;

    NVIC_ICER(0) = 1u << IRQ_EXTI1;
    pend(1u << IRQ_EXTI1);
    result[7] = order;
    return 0;
}
