/*
 * What the data cache of the flash may hold of a sector that was erased: the old words, until the cache is reset
 * (RM0090 section 3.5.2). Which lines it has is not known, so it may be any of the sector.
 */
#ifndef STALE_H
#define STALE_H

#include <stdbool.h>
#include <stdint.h>

struct stale {
    bool cached;    /* the cache has been on since it was reset */
    uint32_t from;  /* the sector, as an offset in the memory; */
    uint32_t bytes; /* 0: none */
};

static inline void stale_note_erase(struct stale *stale, uint32_t from, uint32_t bytes)
{
    if (stale->cached) {
        stale->from = from;
        stale->bytes = bytes;
    }
}

static inline bool stale_has(const struct stale *stale, uint32_t offset)
{
    return offset - stale->from < stale->bytes;
}

#endif
