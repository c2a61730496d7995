/*
 * The memories of an STM32F405/407 with 1 MB of flash (RM0090 section 2.3), as arrays of the host that Unicorn maps.
 */
#ifndef MEMORY_H
#define MEMORY_H

#include <stdbool.h>
#include <stdint.h>
#include <unicorn/unicorn.h>

#define MEMORY_FLASH_BASE UINT32_C(0x08000000)
#define MEMORY_FLASH_BYTES UINT32_C(0x100000)
#define MEMORY_CCM_BASE UINT32_C(0x10000000)
#define MEMORY_CCM_BYTES UINT32_C(0x10000)
#define MEMORY_SYSTEM_BASE UINT32_C(0x1FFF7000) /* one-time area, unique id and size of the flash */
#define MEMORY_OPTIONS_BASE UINT32_C(0x1FFFC000)
#define MEMORY_PAGE_BYTES UINT32_C(0x1000)
#define MEMORY_SRAM_BASE UINT32_C(0x20000000)
#define MEMORY_SRAM_BYTES UINT32_C(0x20000)
#define MEMORY_SRAM1_BYTES UINT32_C(0x1C000) /* of them, which can be seen at address 0, too */

/* What the RAM holds at power-on, so that use of what was never written shows and the stack can be measured. */
#define MEMORY_UNTOUCHED UINT8_C(0xA5)

struct memory {
    uint8_t *flash;       /* 1 MB, of which a smaller part has the first half */
    uint32_t flash_bytes; /* that the part has */
    uint8_t *ccm;
    uint8_t *sram;
    uint8_t *system;
    uint8_t *options;
    bool sram_at_0;      /* else the flash is (section 2.4) */
    bool sram_seen_at_0; /* by Unicorn */
    bool ccm_is_off;     /* its clock is (section 7.3.10): an access leads nowhere */
    bool changed;        /* which Unicorn does not know yet */
};

/* Another memory is at address 0 from the next instruction on. */
void memory_put_at_0(struct memory *memory, bool sram);

void memory_switch_ccm(struct memory *memory, bool on);

/* Tells Unicorn what has changed; not while it runs. */
bool memory_map_again(struct memory *memory, uc_engine *engine);

/* The RAM holds what it does at power-on. */
void memory_forget(struct memory *memory);

/* Maps all into the addresses of the processor; the part has 512 or 1024 kB of flash, and the factory has measured the
 * internal reference (VREFIN_CAL). */
bool memory_init(struct memory *memory, uc_engine *engine, uint32_t flash_kb, uint16_t calibration);
void memory_discard(struct memory *memory);

/* Where `bytes` bytes at an address of a memory are; null if they are not all inside one. */
uint8_t *memory_find(struct memory *memory, uint32_t address, uint32_t bytes);

/* Word of any memory, little-endian; false if there is none. */
bool memory_read_word(struct memory *memory, uint32_t address, uint32_t *word);

static inline bool memory_is_flash(const struct memory *memory, uint32_t address)
{
    return address - MEMORY_FLASH_BASE < MEMORY_FLASH_BYTES || (!memory->sram_at_0 && address < MEMORY_FLASH_BYTES);
}

#endif
