/* Erases sector 4 and writes eight words into it; result[0] counts what went well, result[1] the errors. CACHED: with
 * the data cache on; result[2]: the third word, [3] with the cache off, [4] on again, [5] after it was reset. */
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

static void reset_cache(void)
{
    FLASH_ACR = 0;
    FLASH_ACR = 1u << 12;
    FLASH_ACR = 0;
    FLASH_ACR = 1u << 10;
}

static void look_at_third(void)
{
    result[2] = REG(TARGET + 8);
    FLASH_ACR = 0;
    result[3] = REG(TARGET + 8);
    FLASH_ACR = 1u << 10;
    result[4] = REG(TARGET + 8);
    reset_cache();
    result[5] = REG(TARGET + 8);
}

int main(void)
{
    FLASH_KEYR = 0x45670123;
    FLASH_KEYR = 0xCDEF89AB;
    FLASH_CR = 2u << 8 | 4u << 3 | 2;
    FLASH_CR |= 1u << 16;
    wait();
#ifdef CACHED
    reset_cache();
#endif
    FLASH_CR = 2u << 8 | 1;
    for (uint32_t i = 0; i < 8; i++) {
        REG(TARGET + 4 * i) = 0x11111111u * (i + 1);
        wait();
    }
#ifdef AGAIN
    REG(TARGET + 8) = 0x33333333;
    wait();
#endif
#ifdef CACHED
    look_at_third();
#else
    (void)look_at_third;
#endif
    return 0;
}
