#include "hal_flash.h"

#include <string.h>

#include "host_private.h"

enum {
    ERASED = 0xFF
};

/* What one operation does: from `begin` up to `end` of its `length` bytes, and what it reports. */
struct effect {
    uint32_t begin;
    uint32_t end;
    bool success;
};

static struct effect faulty_effect(enum host_flash_done done, uint32_t length, bool success)
{
    bool last_half = done == HOST_FLASH_LAST_HALF;
    bool all = done == HOST_FLASH_ALL;
    uint32_t first_end = done == HOST_FLASH_NOTHING ? 0 : length / 2;
    return (struct effect){
        .begin = last_half ? length / 2 : 0,
        .end = all || last_half ? length : first_end,
        .success = success,
    };
}

/* Counts the operation and looks whether it is one that goes wrong. */
static struct effect next_effect(struct host_machine *machine, uint32_t length)
{
    const struct host_faults *faults = &machine->faults;
    uint32_t operation = ++machine->flash_operations;
    if (faults->flash_cut_after != 0 && operation >= faults->flash_cut_after) {
        bool later = operation > faults->flash_cut_after;
        return faulty_effect(later ? HOST_FLASH_NOTHING : faults->flash_done, length, true);
    }
    if (operation == faults->flash_fail_at || operation == faults->flash_silent_at) {
        return faulty_effect(faults->flash_done, length, operation != faults->flash_fail_at);
    }
    return (struct effect){.end = length, .success = true};
}

static uint8_t *area_at(struct host_machine *machine, unsigned area, uint32_t offset, uint32_t length)
{
    (void)length; /* where there are no assertions */
    assert(area < HAL_FLASH_AREAS);
    assert(!machine->faults.no_flash);
    assert(offset <= HAL_FLASH_AREA_BYTES && length <= HAL_FLASH_AREA_BYTES - offset);
    return &machine->flash[area][offset];
}

bool hal_flash_is_there(void)
{
    return !host_current()->faults.no_flash;
}

void hal_flash_read(unsigned area, uint32_t offset, uint8_t *bytes, uint32_t length)
{
    memcpy(bytes, area_at(host_current(), area, offset, length), length);
}

/* Programming takes bits from 1 to 0 and never back: what is there already stays in, and that is reported. */
bool hal_flash_write_word(unsigned area, uint32_t offset, const uint8_t bytes[HAL_FLASH_WORD_BYTES])
{
    static const uint8_t erased_word[HAL_FLASH_WORD_BYTES] = {ERASED, ERASED, ERASED, ERASED};
    struct host_machine *machine = host_current();
    assert(offset % HAL_FLASH_WORD_BYTES == 0);
    if (machine->faults.no_flash) {
        return false;
    }
    uint8_t *word = area_at(machine, area, offset, HAL_FLASH_WORD_BYTES);
    struct effect effect = next_effect(machine, HAL_FLASH_WORD_BYTES);
    bool fits = true;
    if (effect.begin < effect.end && memcmp(word, erased_word, HAL_FLASH_WORD_BYTES) != 0) {
        machine->flash_rewrites++;
    }
    for (uint32_t i = effect.begin; i < effect.end; i++) {
        word[i] &= bytes[i];
        fits = fits && word[i] == bytes[i];
    }
    return effect.success && fits;
}

bool hal_flash_erase(unsigned area)
{
    struct host_machine *machine = host_current();
    if (machine->faults.no_flash) {
        return false;
    }
    uint8_t *bytes = area_at(machine, area, 0, HAL_FLASH_AREA_BYTES);
    struct effect effect = next_effect(machine, HAL_FLASH_AREA_BYTES);
    memset(bytes + effect.begin, ERASED, effect.end - effect.begin);
    return effect.success;
}
