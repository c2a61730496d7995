#include "memory.h"

#include <stdlib.h>
#include <string.h>

static uint8_t *allocate(uint32_t bytes, uint8_t filling)
{
    uint8_t *memory = aligned_alloc(MEMORY_PAGE_BYTES, bytes);
    if (memory == NULL) {
        return NULL;
    }
    memset(memory, filling, bytes);
    return memory;
}

static void fill_system_area(struct memory *memory, uint32_t flash_kb, uint16_t calibration)
{
    static const uint8_t id[12] = "VBOARD-0001";
    memcpy(memory->system + 0xA10, id, sizeof id);       /* RM0090 section 39.1: unique device id */
    memory->system[0xA22] = (uint8_t)(flash_kb & 0xFFU); /* section 39.2 */
    memory->system[0xA23] = (uint8_t)(flash_kb >> 8);
    memory->system[0xA2A] = (uint8_t)(calibration & 0xFFU); /* DS8626: VREFIN_CAL */
    memory->system[0xA2B] = (uint8_t)(calibration >> 8);
}

static bool map(uc_engine *engine, uint32_t base, uint32_t bytes, uint32_t rights, uint8_t *memory)
{
    /* Unicorn 2.0 discards stores to what may not be written only after the rights were set a second time. */
    return uc_mem_map_ptr(engine, base, bytes, rights, memory) == UC_ERR_OK &&
           uc_mem_protect(engine, base, bytes, rights) == UC_ERR_OK;
}

static bool map_at_0(const struct memory *memory, uc_engine *engine)
{
    return memory->sram_at_0 ? map(engine, 0, MEMORY_SRAM1_BYTES, UC_PROT_ALL, memory->sram)
                             : map(engine, 0, memory->flash_bytes, UC_PROT_READ | UC_PROT_EXEC, memory->flash);
}

static bool map_all(const struct memory *memory, uc_engine *engine)
{
    /* The CCM RAM hangs on the data bus only: nothing can be executed from it (section 2.3.1). */
    return map_at_0(memory, engine) &&
           map(engine, MEMORY_FLASH_BASE, memory->flash_bytes, UC_PROT_READ | UC_PROT_EXEC, memory->flash) &&
           map(engine, MEMORY_CCM_BASE, MEMORY_CCM_BYTES, UC_PROT_READ | UC_PROT_WRITE, memory->ccm) &&
           map(engine, MEMORY_SYSTEM_BASE, MEMORY_PAGE_BYTES, UC_PROT_READ, memory->system) &&
           map(engine, MEMORY_OPTIONS_BASE, MEMORY_PAGE_BYTES, UC_PROT_READ, memory->options) &&
           map(engine, MEMORY_SRAM_BASE, MEMORY_SRAM_BYTES, UC_PROT_ALL, memory->sram);
}

bool memory_init(struct memory *memory, uc_engine *engine, uint32_t flash_kb, uint16_t calibration)
{
    memory->flash = allocate(MEMORY_FLASH_BYTES, 0xFF);
    memory->ccm = allocate(MEMORY_CCM_BYTES, MEMORY_UNTOUCHED);
    memory->sram = allocate(MEMORY_SRAM_BYTES, MEMORY_UNTOUCHED);
    memory->system = allocate(MEMORY_PAGE_BYTES, 0xFF);
    memory->options = allocate(MEMORY_PAGE_BYTES, 0xFF);
    if (memory->flash == NULL || memory->ccm == NULL || memory->sram == NULL || memory->system == NULL ||
        memory->options == NULL) {
        return false;
    }
    fill_system_area(memory, flash_kb, calibration);
    memory->flash_bytes = flash_kb * 1024U;
    return map_all(memory, engine);
}

void memory_put_at_0(struct memory *memory, bool sram)
{
    memory->changed = memory->changed || memory->sram_at_0 != sram;
    memory->sram_at_0 = sram;
}

void memory_switch_ccm(struct memory *memory, bool on)
{
    memory->changed = memory->changed || memory->ccm_is_off == on;
    memory->ccm_is_off = !on;
}

bool memory_map_again(struct memory *memory, uc_engine *engine)
{
    uint32_t before = memory->sram_seen_at_0 ? MEMORY_SRAM1_BYTES : memory->flash_bytes;
    uint32_t ccm_rights = memory->ccm_is_off ? UC_PROT_NONE : UC_PROT_READ | UC_PROT_WRITE;
    memory->changed = false;
    memory->sram_seen_at_0 = memory->sram_at_0;
    return uc_mem_unmap(engine, 0, before) == UC_ERR_OK && map_at_0(memory, engine) &&
           uc_mem_protect(engine, MEMORY_CCM_BASE, MEMORY_CCM_BYTES, ccm_rights) == UC_ERR_OK;
}

void memory_forget(struct memory *memory)
{
    memset(memory->ccm, MEMORY_UNTOUCHED, MEMORY_CCM_BYTES);
    memset(memory->sram, MEMORY_UNTOUCHED, MEMORY_SRAM_BYTES);
}

void memory_discard(struct memory *memory)
{
    free(memory->flash);
    free(memory->ccm);
    free(memory->sram);
    free(memory->system);
    free(memory->options);
    *memory = (struct memory){.flash = NULL};
}

static uint8_t *inside(uint8_t *memory, uint32_t base, uint32_t size, uint32_t address, uint32_t bytes)
{
    return address - base < size && bytes <= size - (address - base) ? memory + (address - base) : NULL;
}

uint8_t *memory_find(struct memory *memory, uint32_t address, uint32_t bytes)
{
    uint8_t *found = inside(memory->sram, MEMORY_SRAM_BASE, MEMORY_SRAM_BYTES, address, bytes);
    if (found == NULL) {
        found = inside(memory->flash, MEMORY_FLASH_BASE, MEMORY_FLASH_BYTES, address, bytes);
    }
    if (found == NULL && !memory->ccm_is_off) {
        found = inside(memory->ccm, MEMORY_CCM_BASE, MEMORY_CCM_BYTES, address, bytes);
    }
    if (found == NULL) {
        found = memory->sram_at_0 ? inside(memory->sram, 0, MEMORY_SRAM1_BYTES, address, bytes)
                                  : inside(memory->flash, 0, MEMORY_FLASH_BYTES, address, bytes);
    }
    return found;
}

bool memory_read_word(struct memory *memory, uint32_t address, uint32_t *word)
{
    const uint8_t *bytes = memory_find(memory, address, 4);
    if (bytes == NULL) {
        return false;
    }
    *word = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
    return true;
}
