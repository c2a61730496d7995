/* What is at address 0: the flash, or SRAM1 with code that is executed there. */
#include "measure.h"
#include "part.h"

#define SYSCFG_MEMRMP REG(0x40013800u)
#define RCC_APB2RSTR REG(RCC + 0x24)
#define SYSCFG_BIT (1u << 14)
#define AT_0(address) REG((uintptr_t)(address) & 0xFFFFFu)

static volatile uintptr_t low; /* a compiler takes a plain 0 for a mistake */

/* The board executes nothing at address 0 itself. */
__asm__(".pushsection .ramcode, \"ax\"\n nop\n nop\n .popsection");
MEASURE(empty, ".ramcode, \"ax\"", "")
MEASURE(loads, ".ramcode, \"ax\"", HUNDRED("ldr r3, [r4]\n nop"))
MEASURE(literals, ".ramcode, \"ax\"", HUNDRED("ldr.w r3, 1f\n nop") "b 2f\n .align 2\n1: .word 0\n2:\n")
MEASURE(branches, ".ramcode, \"ax\"", HUNDRED("b 1f\n nop\n1:"))

static uint32_t memory[4] = {(uint32_t)(uintptr_t)memory, 1, 2, 3};

static uint32_t cycles_of(measure *code, uint32_t base)
{
    measure *there = (measure *)(((uintptr_t)code & 0x1FFFFu) | base | 1u);
    return there(&DWT_CYCCNT, memory);
}

static void measure_all(volatile uint32_t *to, uint32_t base)
{
    uint32_t none = cycles_of(empty, base);
    to[0] = cycles_of(loads, base) - none;
    to[1] = cycles_of(literals, base) - none;
    to[2] = cycles_of(branches, base) - none;
}

int main(void)
{
    run_at_168_mhz();
    RCC_APB2ENR |= SYSCFG_BIT;
    (void)RCC_APB2ENR;
    (void)RCC_APB2ENR;
    result[0] = REG(low) == REG(0x08000000);
#ifdef MODE
    SYSCFG_MEMRMP = MODE;
#endif
    SCB_VTOR = 0x08000000;
    SYSCFG_MEMRMP = 3;
    result[1] = SYSCFG_MEMRMP;
    result[2] = AT_0(&memory[1]);
    AT_0(&memory[2]) = 77;
    result[3] = memory[2];
    measure_all(&result[4], 0x20000000);
    measure_all(&result[7], 0);
#ifdef PAST
    result[10] = REG(0x1C000);
#endif
    RCC_APB2RSTR = SYSCFG_BIT;
    RCC_APB2RSTR = 0;
    result[11] = REG(low) == REG(0x08000000);
#ifdef NO_CCM
    REG(0x10000000) = 5;
    result[12] = REG(0x10000000);
    RCC_AHB1ENR &= ~(1u << 20);
    result[13] = REG(0x10000000);
#endif
    return 0;
}
