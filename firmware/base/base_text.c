#include "base_text.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    DIGITS_MAX = 20,                /* of 2^64 - 1 */
    DECIMAL_BYTES = 1 + DIGITS_MAX, /* with a minus */
    HEX_BITS = 4,
};

static const uint64_t powers_of_ten[DIGITS_MAX - 1] = {
    UINT64_C(10000000000000000000),
    UINT64_C(1000000000000000000),
    UINT64_C(100000000000000000),
    UINT64_C(10000000000000000),
    UINT64_C(1000000000000000),
    UINT64_C(100000000000000),
    UINT64_C(10000000000000),
    UINT64_C(1000000000000),
    UINT64_C(100000000000),
    UINT64_C(10000000000),
    UINT64_C(1000000000),
    UINT64_C(100000000),
    UINT64_C(10000000),
    UINT64_C(1000000),
    UINT64_C(100000),
    UINT64_C(10000),
    UINT64_C(1000),
    UINT64_C(100),
    UINT64_C(10),
};

void text_init(struct text *text, uint8_t *bytes, uint32_t capacity)
{
    *text = (struct text){.bytes = bytes, .capacity = capacity};
}

void text_put_byte(struct text *text, uint8_t byte)
{
    if (text->length < text->capacity) {
        text->bytes[text->length] = byte;
        text->length++;
    }
}

void text_put_string(struct text *text, const char *string)
{
    for (const char *next = string; *next != '\0'; next++) {
        text_put_byte(text, (uint8_t)*next);
    }
}

static void text_put_decimal(struct text *text, bool negative, uint64_t value, uint32_t width)
{
    uint8_t bytes[DECIMAL_BYTES];
    struct text decimal;

    text_init(&decimal, bytes, sizeof bytes);
    if (negative) {
        text_put_byte(&decimal, '-');
    }
    uint32_t sign = decimal.length;
    for (size_t i = 0; i < sizeof powers_of_ten / sizeof powers_of_ten[0]; i++) {
        uint8_t digit = '0';
        for (; value >= powers_of_ten[i]; value -= powers_of_ten[i]) {
            digit++;
        }
        if (digit != '0' || decimal.length > sign) {
            text_put_byte(&decimal, digit);
        }
    }
    text_put_byte(&decimal, (uint8_t)('0' + value));
    for (uint32_t blanks = decimal.length; blanks < width; blanks++) {
        text_put_byte(text, ' ');
    }
    for (uint32_t i = 0; i < decimal.length; i++) {
        text_put_byte(text, bytes[i]);
    }
}

void text_put_unsigned(struct text *text, uint64_t value, uint32_t width)
{
    text_put_decimal(text, false, value, width);
}

void text_put_signed(struct text *text, int64_t value, uint32_t width)
{
    uint64_t bits = (uint64_t)value;
    text_put_decimal(text, value < 0, value < 0 ? 0U - bits : bits, width);
}

void text_put_hex(struct text *text, uint32_t value, uint32_t digits)
{
    static const uint8_t hex[] = {'0', '1', '2', '3', '4', '5', '6', '7', '8', '9', 'A', 'B', 'C', 'D', 'E', 'F'};
    for (uint32_t place = digits; place-- > 0;) {
        text_put_byte(text, hex[(value >> (HEX_BITS * place)) & (sizeof hex - 1U)]);
    }
}
