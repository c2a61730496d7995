/*
 * The EEPROM: 256 bytes that the unit keeps without power, on top of the store of texts.
 *
 * Comes in: bytes to keep. Goes out: the same bytes, now and after a reset. All of them are one text in slot
 * GVE_MEMORY_SLOT of the store, and a copy in RAM. A write stores them anew, so after a power cut at any moment all
 * bytes of the write are the old ones or all are the new ones. Writing what is there writes nothing. A write takes as
 * long as the store does, with an erase up to 2 s. Main only; 300 bytes.
 *
 * Life: 425 writes between erases of one of two areas of 10 000 erases each, 8.5 million writes.
 */
#ifndef GVE_MEMORY_H
#define GVE_MEMORY_H

#include <stdbool.h>
#include <stdint.h>

#include "../../store/store.h"

enum {
    GVE_MEMORY_BYTES = 256,
    GVE_MEMORY_WORD_BYTES = 4, /* of a number that is kept with its low byte first */
    GVE_MEMORY_SLOT = 0,
};

/* What the bytes mean to the unit. */
enum {
    GVE_MEMORY_RELAY = 0x01,    /* function of the relay */
    GVE_MEMORY_POLARITY = 0x05, /* of STEP (bits 0-3) and DIR (bits 4-7) */
    GVE_MEMORY_COUPLING = 0x0C, /* 1, 2, 3: axis A makes every pulse of X, Y, Z */
    GVE_MEMORY_SERIAL = 0xF8,   /* four bytes: day, month, year, piece */
    GVE_MEMORY_BRAKE = 0xFD,    /* time to the release of the brake, 0.1 s */
};

struct gve_memory {
    struct store store;
    bool damaged; /* what was kept could not be read at the start, and nothing has been written since */
    uint8_t bytes[GVE_MEMORY_BYTES];
};

/* Finds what is kept. Where there is nothing, or it is damaged, the bytes are as delivered: FF, but 00 at
 * GVE_MEMORY_RELAY and 0A at GVE_MEMORY_BRAKE. */
void gve_memory_init(struct gve_memory *memory);

/* The bytes from an address on as one number, low byte first; the address leaves room for them. */
uint32_t gve_memory_word(const struct gve_memory *memory, uint32_t address);

/* Writes a byte, or a number with its low byte first. Where that fails all is as before, here and in the store. */
enum store_error gve_memory_write_byte(struct gve_memory *memory, uint32_t address, uint8_t byte);
enum store_error gve_memory_write_word(struct gve_memory *memory, uint32_t address, uint32_t word);

#endif
