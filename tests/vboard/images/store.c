/* Erases sector 4 and writes eight words into it; result[0] counts what went well, result[1] the errors. */
#include "part.h"

#define TARGET 0x08010000u

static void wait(void)
{
    while ((FLASH_SR & 1u << 16) != 0) {
    }
    if ((FLASH_SR & 0xF2) != 0) {
        result[1]++;
        FLASH_SR = 0xF2;
    } else {
        result[0]++;
    }
}

int main(void)
{
    FLASH_KEYR = 0x45670123;
    FLASH_KEYR = 0xCDEF89AB;
    FLASH_CR = 2u << 8 | 4u << 3 | 2;
    FLASH_CR |= 1u << 16;
    wait();
    FLASH_CR = 2u << 8 | 1;
    for (uint32_t i = 0; i < 8; i++) {
        REG(TARGET + 4 * i) = 0x11111111u * (i + 1);
        wait();
    }
    return 0;
}
