/*
 * A text under test in a block of its own length, so that a sanitizer sees what reads past its end.
 */
#ifndef EXACT_TEXT_H
#define EXACT_TEXT_H

#include <stddef.h>
#include <stdint.h>

struct exact_text {
    uint8_t *bytes; /* NULL: none yet */
    uint32_t length;
};

/* Holds these bytes instead of those before. */
void exact_text_take(struct exact_text *text, const void *bytes, size_t length);

/* Holds nothing any more. */
void exact_text_free(struct exact_text *text);

#endif
