/* A sector is erased with PSIZE as defined, perhaps behind the data cache; result[0]: FLASH_SR, result[1]: one word. */
#include "part.h"

#ifndef SECTOR
#define SECTOR 4
#endif
#ifndef SIZE
#define SIZE 2
#endif

static void wait(void)
{
    while ((FLASH_SR & 1u << 16) != 0) {
    }
}

int main(void)
{
#ifdef DIRTY
    RCC_CIR = 0;
#else
    FLASH_SR = 0xF3;
#endif
#ifdef CACHE
    FLASH_ACR = 1u << 10;
#endif
    FLASH_KEYR = 0x45670123;
    FLASH_KEYR = 0xCDEF89AB;
    FLASH_CR = SIZE << 8 | SECTOR << 3 | 2;
    FLASH_CR |= 1u << 16;
    wait();
#ifdef FORGET
    FLASH_ACR = 0;
    FLASH_ACR = 1u << 12;
    FLASH_ACR = 0;
    FLASH_ACR = 1u << 10;
#endif
    result[0] = FLASH_SR;
    result[1] = REG(0x08010000);
    return 0;
}
