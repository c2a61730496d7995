/* Option bytes and the voltage detector. */
#include "part.h"

#define FLASH_OPTKEYR REG(FLASH + 0x08)
#define FLASH_OPTCR REG(FLASH + 0x14)
#define PWR_CR REG(0x40007000)
#define PWR_CSR REG(0x40007004)

int main(void)
{
    if ((FLASH_OPTCR & 0xC) == 0) {
        result[10] = FLASH_OPTCR;
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
    result[4] = PWR_CSR & 4;
    PWR_CR |= 1u << 4 | 7u << 5; /* 2.9 V */
    result[5] = PWR_CSR & 4;
    PWR_CR = (PWR_CR & ~(7u << 5)) | 5u << 5; /* 2.7 V */
    result[6] = PWR_CSR & 4;
#ifdef AGAIN
    SCB_AIRCR = 0x05FA0004;
#endif
    return 0;
}
