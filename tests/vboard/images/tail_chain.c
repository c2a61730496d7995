/* Cycles of entries, returns and tail-chains, from RAM: two handlers of one instruction each. */
#include "part.h"

RAMCODE __attribute__((naked)) void exti0_handler(void)
{
    __asm volatile("bx lr");
}

RAMCODE __attribute__((naked)) void exti1_handler(void)
{
    __asm volatile("bx lr");
}

static uint32_t ram_vectors[128] __attribute__((aligned(512)));

RAMCODE static uint32_t time_of(uint32_t bits)
{
    NVIC_ISPR(0) = 0; /* so that what follows is as pipelined in both cases */
    uint32_t before = DWT_CYCCNT;
    NVIC_ISPR(0) = bits;
    __asm volatile("nop\n nop\n nop\n nop" ::: "memory");
    return DWT_CYCCNT - before;
}

int main(void)
{
    for (unsigned i = 0; i < 98; i++) {
        ram_vectors[i] = REG(0x08000000 + 4 * i);
    }
    SCB_VTOR = (uint32_t)ram_vectors;
    NVIC_ISER(0) = 1u << IRQ_EXTI0 | 1u << IRQ_EXTI1;
    uint32_t nothing = time_of(0);
    uint32_t one = time_of(1u << IRQ_EXTI0);
    uint32_t two = time_of(1u << IRQ_EXTI0 | 1u << IRQ_EXTI1);
    result[0] = one - nothing;
    result[1] = two - one;
    return 0;
}
