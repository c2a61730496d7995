/* What is found at the start, and what the PLL's configuration says to a write while it runs. */
#include "part.h"

RAMCODE static uint32_t code_in_ram(void)
{
    return 1;
}

static void look_at_processor(void)
{
    __asm volatile("mrs %0, control" : "=r"(result[12]));
    __asm volatile("mrs %0, psp" : "=r"(result[13]));
    __asm volatile("mrs %0, basepri" : "=r"(result[14]));
    __asm volatile("mrs %0, faultmask" : "=r"(result[15]));
    result[16] = SCB_SCR;
    result[17] = MPU_CTRL;
}

static void look_at_part(void)
{
    result[0] = RCC_CR;
    result[1] = RCC_CFGR & 0xF;
    result[2] = FLASH_SR;
    result[3] = FLASH_CR >> 31;
    result[4] = SYST_CSR & 7;
    result[5] = NVIC_ISPR(2) & NVIC_ISER(2);
    result[6] = SCB_VTOR;
    result[7] = REG16(0x1FFF7A22);
    result[8] = REG(0xE0042000);
    result[10] = SCB_AIRCR;
}

int main(void)
{
    look_at_processor();
    look_at_part();
    RCC_AHB1ENR |= 2;
    (void)RCC_AHB1ENR;
    (void)RCC_AHB1ENR;
#ifdef RESET_ALL
    RCC_AHB1RSTR = 2;
    RCC_AHB1RSTR = 0;
#endif
    result[11] = GPIO_OTYPER(GPIOB);
#ifdef I2S
    RCC_CR |= 1u << 26;
    RCC_PLLCFGR = RCC_PLLCFGR_KEPT | 8 | 336u << 6 | 1u << 22 | 7u << 24;
#endif
#ifdef WRITE
    RCC_PLLCFGR = RCC_PLLCFGR_KEPT | 8 | 336u << 6 | 1u << 22 | 7u << 24;
#endif
#ifdef RESERVED
    RCC_PLLCFGR = 8 | 336u << 6 | 1u << 22 | 7u << 24;
#endif
#ifdef TOO_SOON
    RCC_CFGR = 0;
    while ((RCC_CFGR & 0xC) != 0) {
    }
    RCC_CR &= ~(1u << 24);
    RCC_PLLCFGR = RCC_PLLCFGR_KEPT | 8 | 336u << 6 | 1u << 22 | 7u << 24;
#endif
#ifdef PREFETCH
    FLASH_ACR = 1u << 8;
#endif
#ifdef RESET_CACHE
    FLASH_ACR = 1u << 10;
    FLASH_ACR = 1u << 10 | 1u << 12;
#endif
#ifdef SLEEP
    __asm volatile("wfi");
#endif
#ifdef MPU_OFF
    MPU_CTRL = 0;
#endif
#if defined RAM_CODE
    __asm volatile("cpsie f");
    SCB_VTOR = 0x08000000;
    result[18] = code_in_ram();
#else
    (void)code_in_ram;
#endif
#ifdef READ_LAST
    result[9] = REG(0x080FFFFC);
#endif
    return 0;
}
