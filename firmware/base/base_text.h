/*
 * Text into a buffer of fixed size: bytes, strings, right-aligned decimals, hexadecimals.
 *
 * What does not fit is left out, so `length` never passes `capacity`; who knows the longest text gives the buffer for
 * it. No division: decimals are made by subtraction, at most nine a digit. May be called from anywhere.
 */
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include <stdint.h>

struct text {
    uint8_t *bytes;
    uint32_t capacity;
    uint32_t length;
};

/* An empty text in this buffer. */
void text_init(struct text *text, uint8_t *bytes, uint32_t capacity);

void text_put_byte(struct text *text, uint8_t byte);

/* Puts a string without its terminator. */
void text_put_string(struct text *text, const char *string);

/* Puts a decimal with blanks before it up to `width`; a longer one takes the room it needs. */
void text_put_unsigned(struct text *text, uint64_t value, uint32_t width);
void text_put_signed(struct text *text, int64_t value, uint32_t width);

/* Puts the lowest `digits` hexadecimal digits, at most 8, in upper case. */
void text_put_hex(struct text *text, uint32_t value, uint32_t digits);

#endif
