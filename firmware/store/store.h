/*
 * The store: a few texts, each in a slot of its own, in memory that keeps them without power.
 *
 * Comes in: text to keep. Goes out: the same text after a reset. Texts are appended as records with length, generation
 * and CRC-32 (store_record.h) to one of the two areas of hal_flash; when it is full, the other one is erased and the
 * newest record of each slot copied over. Main only; no copy in RAM.
 *
 * Power cuts: the old text or the new one is there after a cut at any word or inside an erase. A record counts from
 * the moment its last word, the whole-mark, is written, and that is when all before it has been read back; an area
 * counts from the moment the record at its begin is whole, which is written when all copies are. Only then is the
 * area before it made void, and it is erased only when it is to be used again: an erase that was cut is never trusted.
 *
 * Damage: a record that was whole and has not its text any more, because bits of it have changed, is damaged, and so
 * is its slot until the next store: an older text is never taken in its place. Where damage hides which slots are
 * meant, all are damaged. A record without whole-mark is what a cut or a failure has left; it does not count and the
 * text before it does. One wrong bit anywhere makes at most one slot damaged.
 *
 * A part without the memory keeps nothing: all slots count as damaged, so that they tell it, and a store fails.
 *
 * Life: at 10 000 erases for each area the rotation is good for 220 000 stores of the longest text on all slots (11
 * in each area beside the four copies) and for 17 million of 100 bytes. Storing what is stored already writes nothing.
 */
#ifndef STORE_H
#define STORE_H

#include <stdbool.h>
#include <stdint.h>

enum {
    STORE_SLOTS = 4,
    STORE_TEXT_BYTES_MAX = 8400, /* of each text */
};

/* What became of a text that was to be kept. */
enum store_error {
    STORE_OK = 0,
    STORE_WRITE_FAILED = 1, /* the memory reports an error or does not read back what was written; the old text stays,
                               and the next store tries the other area */
    STORE_TOO_LONG = 2,
};

struct store {
    uint32_t generation;         /* the highest of all records and areas */
    uint32_t end;                /* offset after the last record of the present area; its size: it is full */
    uint32_t image[STORE_SLOTS]; /* offset of the record that counts for each slot; 0: none */
    uint8_t area;                /* the present area */
    bool damaged[STORE_SLOTS];   /* what was stored in it cannot be read; image is 0 */
    bool usable;                 /* there is a present area; else the next store begins the other one */
};

/* Finds what is stored. Writes at most one word, where a cut came just before the last step of a change of areas;
 * a cut here does no harm, and calling again finds the same. */
void store_init(struct store *store);

/* Whether something was stored in slot 0 to 3 and cannot be read. */
bool store_is_damaged(const struct store *store, unsigned slot);

/* Bytes of the text kept in slot 0 to 3, once more checked; 0 if there is none or it is empty. */
uint32_t store_length(const struct store *store, unsigned slot);

/* Copies the text kept in slot 0 to 3 to where there is room for it. Returns its length, as store_length tells it. */
uint32_t store_load(const struct store *store, unsigned slot, uint8_t *text);

/* Keeps a text in slot 0 to 3 in place of the one before; an empty text is kept as such. */
enum store_error store_save(struct store *store, unsigned slot, const uint8_t *text, uint32_t length);

#endif
