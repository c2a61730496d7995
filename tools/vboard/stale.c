#include "stale.h"

#include <string.h>

void stale_look_through_cache(struct stale *stale, uint8_t *memory, bool through)
{
    for (unsigned i = 0; i < STALE_WORDS && stale->through != through; i++) {
        const struct stale_word *word = &stale->word[i];
        memcpy(memory + word->offset, through ? word->seems : word->is, word->bytes);
    }
    stale->through = through;
    stale->cached = stale->cached || through;
}

static void drop(struct stale *stale, uint32_t from, uint32_t bytes)
{
    for (unsigned i = 0; i < STALE_WORDS; i++) {
        if (stale->word[i].offset - from < bytes) {
            stale->word[i].bytes = 0;
        }
    }
}

void stale_note_erase(struct stale *stale, uint32_t from, uint32_t bytes)
{
    drop(stale, from, bytes);
    if (stale->cached) {
        stale->from = from;
        stale->bytes = bytes;
    }
}

void stale_note_program(struct stale *stale, const uint8_t *memory, const struct stale_word *word)
{
    drop(stale, word->offset, word->bytes);
    if (stale->cached && memcmp(memory + word->offset, word->seems, word->bytes) != 0) {
        struct stale_word *kept = &stale->word[stale->words++ % STALE_WORDS];
        *kept = *word;
        memcpy(kept->is, memory + word->offset, word->bytes);
    }
}

void stale_forget(struct stale *stale, uint8_t *memory)
{
    stale_look_through_cache(stale, memory, false);
    *stale = (struct stale){.cached = false};
}
