/* A clock is enabled, and what it is for is accessed so many cycles later. */
#include "part.h"

int main(void)
{
#ifdef APB1
    run_at_168_mhz();
    __asm__ volatile("str %1, [%0]\n\t.rept " APB1 "\n\tnop\n\t.endr\n\tstr %1, [%2]" ::"r"(RCC + 0x40), "r"(1),
                     "r"(TIM2 + 0x2C)
                     : "memory");
#elif defined(READ_BACK)
    __asm__ volatile("str %1, [%0]\n\tldr r3, [%0]\n\tstr %1, [%2]" ::"r"(RCC + 0x30), "r"(1), "r"(GPIOA + 0x14)
                     : "memory", "r3");
#else
    __asm__ volatile("str %1, [%0]\n\t.rept " AHB "\n\tnop\n\t.endr\n\tstr %1, [%2]" ::"r"(RCC + 0x30), "r"(1),
                     "r"(GPIOA + 0x14)
                     : "memory");
#endif
    return 0;
}
