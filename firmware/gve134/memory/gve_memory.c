#include "gve_memory.h"

#include <assert.h>
#include <string.h>

/* What is kept: a mark, as another unit may have left a text in the slot, and the bytes. */
enum {
    MARK_BYTES = 4,
    TEXT_BYTES = MARK_BYTES + GVE_MEMORY_BYTES,
    ERASED = 0xFF,
    BYTE_BITS = 8,
    DELIVERED_RELAY = 0x00,
    DELIVERED_BRAKE = 0x0A,
};

static_assert((uint32_t)TEXT_BYTES <= (uint32_t)STORE_TEXT_BYTES_MAX, "all bytes are one text");
static_assert((uint32_t)GVE_MEMORY_SLOT < (uint32_t)STORE_SLOTS, "there is such a slot");

static const uint8_t mark[MARK_BYTES] = {'G', 'V', 'E', 1};

static void deliver(uint8_t bytes[GVE_MEMORY_BYTES])
{
    memset(bytes, ERASED, GVE_MEMORY_BYTES);
    bytes[GVE_MEMORY_RELAY] = DELIVERED_RELAY;
    bytes[GVE_MEMORY_BRAKE] = DELIVERED_BRAKE;
}

/* Copies what is kept. False: there is a text, and it is not what this unit writes. */
static bool load(struct gve_memory *memory)
{
    uint8_t text[TEXT_BYTES] = {0};
    uint32_t length = store_length(&memory->store, GVE_MEMORY_SLOT);
    if (length == 0) {
        return true;
    }
    if (length != TEXT_BYTES) {
        return false;
    }
    (void)store_load(&memory->store, GVE_MEMORY_SLOT, text);
    if (memcmp(text, mark, MARK_BYTES) != 0) {
        return false;
    }
    memcpy(memory->bytes, &text[MARK_BYTES], GVE_MEMORY_BYTES);
    return true;
}

void gve_memory_init(struct gve_memory *memory)
{
    store_init(&memory->store);
    deliver(memory->bytes);
    memory->damaged = !load(memory) || store_is_damaged(&memory->store, GVE_MEMORY_SLOT);
}

uint32_t gve_memory_word(const struct gve_memory *memory, uint32_t address)
{
    assert(address <= GVE_MEMORY_BYTES - GVE_MEMORY_WORD_BYTES);
    uint32_t word = 0;
    for (unsigned i = GVE_MEMORY_WORD_BYTES; i-- > 0;) {
        word = (word << BYTE_BITS) | memory->bytes[address + i];
    }
    return word;
}

static enum store_error write_bytes(struct gve_memory *memory, uint32_t address, const uint8_t *bytes, uint32_t count)
{
    uint8_t text[TEXT_BYTES];
    assert(count <= GVE_MEMORY_BYTES && address <= GVE_MEMORY_BYTES - count);
    if (memcmp(&memory->bytes[address], bytes, count) == 0) {
        return STORE_OK;
    }
    memcpy(text, mark, MARK_BYTES);
    memcpy(&text[MARK_BYTES], memory->bytes, GVE_MEMORY_BYTES);
    memcpy(&text[MARK_BYTES + address], bytes, count);
    enum store_error error = store_save(&memory->store, GVE_MEMORY_SLOT, text, TEXT_BYTES);
    if (error == STORE_OK) {
        memcpy(memory->bytes, &text[MARK_BYTES], GVE_MEMORY_BYTES);
        memory->damaged = false;
    }
    return error;
}

enum store_error gve_memory_write_byte(struct gve_memory *memory, uint32_t address, uint8_t byte)
{
    return write_bytes(memory, address, &byte, 1);
}

enum store_error gve_memory_write_word(struct gve_memory *memory, uint32_t address, uint32_t word)
{
    uint8_t bytes[GVE_MEMORY_WORD_BYTES];
    for (unsigned i = 0; i < GVE_MEMORY_WORD_BYTES; i++) {
        bytes[i] = (uint8_t)(word >> (BYTE_BITS * i));
    }
    return write_bytes(memory, address, bytes, GVE_MEMORY_WORD_BYTES);
}
