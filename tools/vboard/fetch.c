#include "fetch.h"

#include "memory.h"

#define LINE_MASK (~UINT32_C(15)) /* the flash is read in lines of 128 bits */

/* Whether the accelerator has the line of an instruction; it has from now on. */
static bool is_cached(struct fetch *fetch, uint32_t address)
{
    return fetch->art_modelled && flash_instruction_cache_is_on(fetch->flash) && art_fetch(&fetch->art, address);
}

uint32_t fetch_jump(struct fetch *fetch, uint32_t address)
{
    bool in_flash = memory_is_flash(fetch->flash->wires.memory, address);
    uint32_t wait = in_flash && !is_cached(fetch, address) ? fetch->flash->wait_states : 0;
    fetch->line_mask = in_flash ? LINE_MASK : 0;
    fetch->line = address & fetch->line_mask;
    fetch->line_cycle = fetch->clock->now + wait;
    return wait + (fetch->shared_bus && address >= MEMORY_SRAM_BASE ? 1U : 0U);
}

/* The prefetch has begun to read the line when the one before was there. */
void fetch_enter_line(struct fetch *fetch, uint32_t address)
{
    struct clock *clock = fetch->clock;
    uint64_t ready = fetch->line_cycle + fetch->flash->wait_states + 1U;
    fetch->line = address & fetch->line_mask;
    if (fetch->art_modelled && flash_instruction_cache_is_on(fetch->flash) && art_has(&fetch->art, address)) {
        ready = clock->now;
    } else if (!flash_prefetch_is_on(fetch->flash)) {
        ready = clock->now + fetch->flash->wait_states;
    }
    clock->now = ready > clock->now ? ready : clock->now;
    fetch->line_cycle = clock->now;
}

uint32_t fetch_literal_wait(struct fetch *fetch, uint32_t address)
{
    bool cached =
        fetch->art_modelled && flash_data_cache_is_on(fetch->flash) && art_fetch_literal(&fetch->art, address);
    return cached ? 0 : fetch->flash->wait_states;
}
