/*
 * What the data cache of the flash may hold of a sector that was erased: the old words, until the cache is reset. And
 * of a word that was programmed: what it should be, whatever the memory has taken, as the write modifies both (RM0090
 * section 3.6.4). Which lines it has is not known, so it may be any.
 */
#ifndef STALE_H
#define STALE_H

#include <stdbool.h>
#include <stdint.h>

enum {
    STALE_WORDS = 32, /* of the cache: 8 lines of 4 */
    STALE_WORD_BYTES = 8
};

/* A word that has not taken what it should have: what the memory has, and what the cache says. No bytes: none. */
struct stale_word {
    uint32_t offset;
    uint32_t bytes;
    uint8_t is[STALE_WORD_BYTES];
    uint8_t seems[STALE_WORD_BYTES];
};

struct stale {
    bool cached;    /* the cache has been on since it was reset */
    bool through;   /* the memory is looked at through the cache: it shows what words seem to be */
    uint32_t from;  /* the sector, as an offset in the memory; */
    uint32_t bytes; /* 0: none */
    uint32_t words; /* so many were noted; the last ones are kept */
    struct stale_word word[STALE_WORDS];
};

static inline bool stale_has(const struct stale *stale, uint32_t offset)
{
    return offset - stale->from < stale->bytes;
}

/* The cache is on, or not: the memory shows what is read then. */
void stale_look_through_cache(struct stale *stale, uint8_t *memory, bool through);

/* A sector was erased. */
void stale_note_erase(struct stale *stale, uint32_t from, uint32_t bytes);

/* A word was programmed; `memory` shows what it is, and `word` has what it should be. */
void stale_note_program(struct stale *stale, const uint8_t *memory, const struct stale_word *word);

/* The cache is reset; the memory shows what it is. */
void stale_forget(struct stale *stale, uint8_t *memory);

#endif
