#include "hal_flash.h"

#include <assert.h>
#include <string.h>

#include "base_hint.h"
#include "base_tick.h"
#include "board.h"
#include "stm32_edge.h"
#include "stm32_private.h"
#include "stm32f4.h"

/*
 * The areas are the last two sectors of 1 MB; a smaller part does not have them. While a sector is being written or
 * erased the flash answers no read, and the processor would stand still at the first one: all of this file, and all
 * interrupts, run from RAM.
 */
enum {
    SECTOR_FIRST = 10,
    KB_MIN = 1024,
    WORD_WRITES = HAL_FLASH_WORD_BYTES / BOARD_FLASH_BYTES, /* of a word: as wide as the supply allows */
    WIDTH = WORD_WRITES == 1 ? 2 : 1,                       /* of PSIZE, RM0090 3.9.7 */

    WRITE_TICKS_MAX = 2 * TICKS_PER_MS, /* datasheet: 100 us */
};
#define AREA_FIRST 0x080C0000U
#define FLASH_FIRST 0x08000000U
#define IMAGE_BYTES_MAX 0x10000U       /* stm32f405.ld */
#define ERASE_TICKS_MAX (4U * TICK_HZ) /* DS8626: 2 s at 32 bits, 2.6 s at 16 */
#define ERRORS (FLASH_SR_OPERR | FLASH_SR_WRPERR | FLASH_SR_PGAERR | FLASH_SR_PGPERR | FLASH_SR_PGSERR)

/* Sectors 0 to 3 have 16 kB, 4 has 64 kB, the others have 128 kB (RM0090 3.3). */
#ifndef BOARD_LOADER_BYTES
#define BOARD_LOADER_BYTES 0
#endif
#define LOADER_BYTES ((uint32_t)BOARD_LOADER_BYTES)
#define SECTOR_STEP ((LOADER_BYTES <= 0x10000U) ? 0x4000U : 0x20000U)
static_assert((LOADER_BYTES % SECTOR_STEP) == 0U,
              "BOARD_LOADER_BYTES must be where a sector begins: flashing the image would erase the loader");
static_assert(LOADER_BYTES <= (AREA_FIRST - FLASH_FIRST - IMAGE_BYTES_MAX),
              "BOARD_LOADER_BYTES: the image would lie where programs are stored");

static_assert(BOARD_FLASH_BYTES == 4 || BOARD_FLASH_BYTES == 2, "BOARD_FLASH_BYTES: 4 or 2 at a time");

/* The part has both areas. */
static bool areas_are_there;

static uint32_t address_of(unsigned area, uint32_t offset)
{
    return AREA_FIRST + area * (uint32_t)HAL_FLASH_AREA_BYTES + offset;
}

/* Since the last look, however shortly. */
static bool supply_has_changed(void)
{
    return (EXTI_PR & STM32_EDGE_SUPPLY) != 0U;
}

/* Below the level of stm32_supply.c nothing is begun, and what was going on then is not believed: what is written with
 * too low a supply may read well and not last (RM0090 3.6.2). The detector itself is looked at only when EXTI has
 * noticed a change: PWR_CSR takes longer to read than other registers (5.4.2), and the DMA controller, which moves the
 * edges of pulses over the same bus, would wait for it. */
static bool supply_is_good(void)
{
    if (supply_has_changed()) {
        EXTI_PR = STM32_EDGE_SUPPLY;
        if ((PWR_CSR & PWR_CSR_PVDO) != 0U) {
            EXTI_SWIER = STM32_EDGE_SUPPLY; /* to be looked at again */
        }
    }
    return !supply_has_changed();
}

static bool may_begin(void)
{
    return areas_are_there && supply_is_good();
}

/* Waiting counts as life of main: it does what main has asked for, for a limited time. */
static bool wait_until_done(uint32_t ticks_max)
{
    uint32_t start = TIM2_CNT;
    do {
        if (TIM2_CNT - start > ticks_max) {
            return false;
        }
        stm32_watchdog_main_lives();
    } while ((FLASH_SR & FLASH_SR_BSY) != 0);
    return !supply_has_changed() && (FLASH_SR & ERRORS) == 0;
}

/* Apart, as both callers would have it otherwise. */
BASE_APART static void unlock(uint32_t control)
{
    if ((FLASH_CR & FLASH_CR_LOCK) != 0) {
        FLASH_KEYR = FLASH_KEY_1;
        FLASH_KEYR = FLASH_KEY_2;
    }
    FLASH_SR = ERRORS | FLASH_SR_EOP;
    FLASH_CR = control;
}

/* While it is busy a write would hold up the processor (RM0090 3.6.1): after an operation without an end it stays open.
 */
static void lock(void)
{
    if ((FLASH_SR & FLASH_SR_BSY) == 0U) {
        FLASH_CR = FLASH_CR_LOCK;
    }
}

/* What the data cache still holds of an area that was erased is wrong. Of a word that was written it has what that
 * should be, whatever the flash has taken (RM0090 3.6.4). It is cleared while off. */
static void forget_cached(void)
{
    uint32_t access = FLASH_ACR;
    FLASH_ACR = access & ~FLASH_ACR_DCEN;
    FLASH_ACR = (access & ~FLASH_ACR_DCEN) | FLASH_ACR_DCRST;
    FLASH_ACR = access & ~FLASH_ACR_DCEN;
    FLASH_ACR = access;
}

void stm32_flash_start(uint32_t part_kb)
{
    areas_are_there = part_kb >= (uint32_t)KB_MIN;
    FLASH_SR = ERRORS | FLASH_SR_EOP;
    lock();
    FLASH_OPTCR |= FLASH_OPTCR_OPTLOCK;
    (void)supply_is_good(); /* nothing moves yet */
}

bool hal_flash_is_there(void)
{
    return areas_are_there;
}

void hal_flash_read(unsigned area, uint32_t offset, uint8_t *bytes, uint32_t length)
{
    const uint8_t *stored = (const uint8_t *)(uintptr_t)address_of(area, offset);
    stm32_watchdog_main_lives();
    memcpy(bytes, stored, length);
}

/* A word at once, or half of it. */
static void write_part(uint32_t address, uint32_t value, unsigned part)
{
    if (WORD_WRITES == 1) {
        *(volatile uint32_t *)(uintptr_t)address = value;
    } else {
        ((volatile uint16_t *)(uintptr_t)address)[part] = (uint16_t)(value >> 16U * part);
    }
    stm32_barrier();
}

bool hal_flash_write_word(unsigned area, uint32_t offset, const uint8_t bytes[HAL_FLASH_WORD_BYTES])
{
    const volatile uint32_t *word = (volatile uint32_t *)(uintptr_t)address_of(area, offset);
    uint32_t value;
    bool done = may_begin();
    if (!done) {
        return false;
    }
    memcpy(&value, bytes, sizeof value);
    unlock(FLASH_CR_PG | FLASH_CR_PSIZE((uint32_t)WIDTH));
    for (unsigned i = 0; i < (unsigned)WORD_WRITES && done; i++) {
        write_part(address_of(area, offset), value, i);
        done = wait_until_done(WRITE_TICKS_MAX);
    }
    lock();
    forget_cached();
    return done && *word == value;
}

bool hal_flash_erase(unsigned area)
{
    if (!may_begin()) {
        return false;
    }
    unlock(FLASH_CR_SER | FLASH_CR_SNB(SECTOR_FIRST + area) | FLASH_CR_PSIZE((uint32_t)WIDTH));
    FLASH_CR |= FLASH_CR_STRT;
    stm32_barrier();
    bool done = wait_until_done(ERASE_TICKS_MAX);
    lock();
    forget_cached();
    return done;
}
