#include "flash.h"

/* Whether anything in a range of the flash has been executed. */
static bool was_executed(const struct flash *flash, uint32_t offset, uint32_t bytes)
{
    for (uint32_t at = offset; at < offset + bytes; at += 2) {
        if (cost_find(flash->wires.costs, MEMORY_FLASH_BASE + at)->kind != COST_UNKNOWN) {
            return true;
        }
    }
    return false;
}

uint8_t flash_after(const struct flash *flash, uint32_t index, uint8_t before)
{
    if (flash->operation == FLASH_ERASE) {
        return UINT8_MAX;
    }
    return (uint8_t)(before & (uint32_t)(flash->value >> 8U * index) & UINT8_MAX);
}

void flash_change(struct flash *flash, uint32_t bytes)
{
    uint8_t *at = flash->wires.memory->flash + flash->address;
    for (uint32_t i = 0; i < bytes; i++) {
        at[i] = flash_after(flash, i, at[i]);
    }
    flash->code_changed |= was_executed(flash, flash->address, bytes);
}

/* By xorshift32. */
void flash_change_some(struct flash *flash, uint32_t seed)
{
    uint8_t *at = flash->wires.memory->flash + flash->address;
    uint32_t random = (seed + 1U) * UINT32_C(2654435761) | 1U;
    for (uint32_t i = 0; i < flash->bytes; i++) {
        random ^= random << 13;
        random ^= random >> 17;
        random ^= random << 5;
        at[i] = (uint8_t)(at[i] ^ ((at[i] ^ flash_after(flash, i, at[i])) & random >> 11));
    }
    flash->code_changed |= was_executed(flash, flash->address, flash->bytes);
}

void flash_change_all_but_one_bit(struct flash *flash)
{
    uint8_t *at = flash->wires.memory->flash + flash->address;
    uint32_t place = 0;
    while (place + 1U < flash->bytes && at[place] == flash_after(flash, place, at[place])) {
        place++;
    }
    uint32_t differs = at[place] ^ flash_after(flash, place, at[place]);
    flash_change(flash, flash->bytes);
    at[place] ^= (uint8_t)(differs & (0U - differs));
}
