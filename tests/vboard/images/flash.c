/* Unlocking, programming, erasing, and what goes wrong. Sector 4 (64 kB from 0x08010000) is used. */
#include "part.h"

#define TARGET 0x08010000u

static uint32_t wait_in_flash(void)
{
    uint32_t before = cycles();
    while ((FLASH_SR & 1u << 16) != 0) {
    }
    return cycles() - before;
}

static volatile uint32_t spins;

/* Runs from RAM and goes on while the flash is busy. */
RAMCODE static uint32_t wait_in_ram(void)
{
    uint32_t before = DWT_CYCCNT;
    while ((FLASH_SR & 1u << 16) != 0) {
        spins++;
    }
    return DWT_CYCCNT - before;
}

RAMCODE static uint32_t program_from_ram(void)
{
    REG(TARGET + 8) = 0x12345678;
    return wait_in_ram();
}

RAMCODE static uint32_t read_while_busy(void)
{
    REG(TARGET + 12) = 0x9ABCDEF0;
    uint32_t before = DWT_CYCCNT;
    (void)REG(TARGET);
    return DWT_CYCCNT - before;
}

int main(void)
{
    result[0] = FLASH_CR;
    FLASH_CR = 1; /* locked: nothing happens */
    result[1] = FLASH_CR;
    REG(TARGET) = 0; /* not allowed */
    result[2] = FLASH_SR;
    FLASH_SR = 0xF2;
    FLASH_KEYR = 0x45670123;
    FLASH_KEYR = 0xCDEF89AB;
    result[3] = FLASH_CR;
    FLASH_CR = 2u << 8 | 1; /* words, PG */
    REG(TARGET) = 0xFFFF00FF;
    result[4] = wait_in_flash(); /* the stall is over when the loop gets to run */
    REG(TARGET) = 0x00FFFFFF;
    result[5] = wait_in_flash();
    result[6] = REG(TARGET); /* bits go from 1 to 0 only */
    REG16(TARGET + 4) = 0;   /* not as wide as PSIZE */
    result[7] = FLASH_SR;
    FLASH_SR = 0xF2;
    result[8] = REG(TARGET + 4);
    result[9] = program_from_ram();
    result[10] = REG(TARGET + 8);
    result[11] = spins > 10;
    result[12] = read_while_busy();
    FLASH_CR = 2u << 8 | 4u << 3 | 2;
    uint32_t before = cycles();
    FLASH_CR |= 1u << 16;
    (void)wait_in_flash();
    result[13] = (cycles() - before) / 16000; /* ms */
    result[14] = REG(TARGET);
    result[15] = FLASH_SR;
    FLASH_CR = 1u << 31;
    FLASH_KEYR = 1; /* a wrong key locks for good */
    FLASH_KEYR = 0x45670123;
    FLASH_KEYR = 0xCDEF89AB;
    result[16] = FLASH_CR;
    return 0;
}
