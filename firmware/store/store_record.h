/*
 * One record of the store: a text in flash, with all that tells whether it can be trusted. Private to the store.
 *
 * Comes in: a text. Goes out: words to one area of hal_flash, each written once and read back before the next. What a
 * record looks like, at an offset that is a multiple of four; numbers have their low byte first:
 *
 *   offset        bytes
 *   0             20     head: magic 4, generation 4, length of the text 2, slot 1, zero 1,
 *                        CRC-32 of these 12 bytes and the text 4, CRC-32 of these 16 bytes 4
 *   20            20     the head once more
 *   40            n      the text, filled up with FF to whole words
 *   40 + n        4      whole-mark: written when all before has been read back
 *   44 + n        4      void-mark: written when the record must not count any more
 *
 * A cut is told from damage by the order of writing: without its whole-mark a record was never finished and does not
 * count; with it, whatever is wrong is damage. A mark is written as 0 and counts if at most STORE_MARK_ONES_MAX of its
 * bits read 1, so a mark that a cut left half written does not count, and no flipped bit makes or breaks one. No single
 * bit can make both heads unreadable.
 * The record at offset 0 of an area has no text; it says that the area as a whole is good.
 */
#ifndef STORE_RECORD_H
#define STORE_RECORD_H

#include <stdbool.h>
#include <stdint.h>

enum {
    STORE_HEAD_BYTES = 20,
    STORE_MARK_BYTES = 4,
    STORE_RECORD_EXTRA_BYTES = 2 * STORE_HEAD_BYTES + 2 * STORE_MARK_BYTES, /* what a record has besides its text */
    STORE_MARK_ONES_MAX = 4,
};

enum store_record_state {
    STORE_RECORD_BLANK,      /* nothing has been written here */
    STORE_RECORD_HEADLESS,   /* cut while its first head was being written; takes the place of two heads */
    STORE_RECORD_UNFINISHED, /* cut or failed before its whole-mark */
    STORE_RECORD_FINISHED,   /* has its whole-mark; whether the text is still what was written is another question */
    STORE_RECORD_VOID,       /* was finished, and does not count any more */
    STORE_RECORD_LOST,       /* was begun, and neither head can be read: slot and size are not known */
};

struct store_record {
    uint32_t generation;
    uint32_t length;     /* of the text, bytes */
    uint32_t crc;        /* of the head's first fields and the text */
    uint32_t size_bytes; /* in flash; 0 if BLANK or LOST */
    uint8_t slot;        /* 0 to 3 */
    uint8_t state;       /* enum store_record_state */
};

/* What a record with a text of this length takes in flash. */
uint32_t store_record_size_bytes(uint32_t length);

/* Reads the heads and marks at an offset, from which at least STORE_RECORD_EXTRA_BYTES are left in the area. */
struct store_record store_record_read(unsigned area, uint32_t offset);

/* Whether the text of a readable record is what was written. */
bool store_record_is_intact(unsigned area, uint32_t offset, const struct store_record *record);

/* Writes a record where all is blank. False: the memory reports an error or something does not read back as written;
 * the record may count all the same. */
bool store_record_write(unsigned area, uint32_t offset, unsigned slot, uint32_t generation, const uint8_t *text,
                        uint32_t length);

/* Writes a finished record that is not intact: it says that what the slot had is not known. */
bool store_record_write_damaged(unsigned area, uint32_t offset, unsigned slot, uint32_t generation);

/* Copies a finished record, byte by byte, to where all is blank. False: it does not read back as written. */
bool store_record_copy(unsigned from_area, uint32_t from_offset, unsigned to_area, uint32_t to_offset,
                       uint32_t size_bytes);

/* Makes a readable record void; nothing if that has been tried before. False: it does not read back. */
bool store_record_make_void(unsigned area, uint32_t offset, const struct store_record *record);

/* Copies the text of a readable record. */
void store_record_read_text(unsigned area, uint32_t offset, const struct store_record *record, uint8_t *text);

/* Whether a readable record has this text. */
bool store_record_has_text(unsigned area, uint32_t offset, const struct store_record *record, const uint8_t *text,
                           uint32_t length);

/* Whether nothing has been written from `begin` up to `end`, multiples of four. */
bool store_flash_is_blank(unsigned area, uint32_t begin, uint32_t end);

#endif
