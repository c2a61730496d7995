/* Option bytes, and what the voltage detector says at several levels: result[4 + level], 0 or 4. */
#include "part.h"

#define FLASH_OPTKEYR REG(FLASH + 0x08)
#define FLASH_OPTCR REG(FLASH + 0x14)
#define PWR_CR REG(0x40007000)
#define PWR_CSR REG(0x40007004)

#ifndef SETTLE_US
#define SETTLE_US 110
#endif

static void wait_us(uint32_t us)
{
    uint32_t before = cycles();
    while (cycles() - before < 16 * us) {
    }
}

int main(void)
{
    if ((FLASH_OPTCR & 0xC) == 0) {
        result[14] = FLASH_OPTCR;
        return 0;
    }
    result[0] = FLASH_OPTCR;
    FLASH_OPTCR = 0;
    result[1] = FLASH_OPTCR; /* locked */
    FLASH_OPTKEYR = 0x08192A3B;
    FLASH_OPTKEYR = 0x4C5D6E7F;
    result[2] = FLASH_OPTCR;
    FLASH_OPTCR &= ~0xCu;
    FLASH_OPTCR |= 2;
    while ((FLASH_SR & 1u << 16) != 0) {
    }
    FLASH_OPTCR |= 1;
    result[3] = FLASH_OPTCR;
    RCC_APB1ENR |= 1u << 28;
    settle();
    result[13] = PWR_CSR & 4; /* off */
    for (uint32_t level = 0; level < 8; level++) {
        PWR_CR = (PWR_CR & ~(7u << 5)) | 1u << 4 | level << 5;
        wait_us(SETTLE_US);
        result[4 + level] = PWR_CSR & 4;
    }
#ifdef AGAIN
    SCB_AIRCR = 0x05FA0004;
#endif
    return 0;
}
