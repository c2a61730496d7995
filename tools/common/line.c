#include "line.h"

#include <limits.h>
#include <string.h>

enum {
    DIGITS_MAX = 20,
    HEX_DIGITS_MAX = 8
};

static const char digit_pairs[] = "0001020304050607080910111213141516171819"
                                  "2021222324252627282930313233343536373839"
                                  "4041424344454647484950515253545556575859"
                                  "6061626364656667686970717273747576777879"
                                  "8081828384858687888990919293949596979899";

char *line_put_unsigned(char *at, uint64_t value)
{
    char digits[DIGITS_MAX];
    unsigned first = DIGITS_MAX;
    while (value >= 10U) {
        first -= 2U;
        memcpy(&digits[first], &digit_pairs[2U * (value % 100U)], 2U);
        value /= 100U;
    }
    if (value > 0 || first == DIGITS_MAX) {
        digits[--first] = (char)('0' + (char)value);
    }
    memcpy(at, &digits[first], DIGITS_MAX - first);
    return at + (DIGITS_MAX - first);
}

char *line_put_signed(char *at, int64_t value)
{
    uint64_t size = (uint64_t)value;
    if (value < 0) {
        *at++ = '-';
        size = 0U - size;
    }
    return line_put_unsigned(at, size);
}

char *line_put_fixed(char *at, uint64_t value, unsigned decimals)
{
    uint64_t unit = 1;
    for (unsigned i = 0; i < decimals; i++) {
        unit *= 10U;
    }
    at = line_put_unsigned(at, value / unit);
    *at++ = '.';
    uint64_t rest = value % unit;
    for (unsigned i = decimals; i > 0; i--) {
        at[i - 1U] = (char)('0' + (char)(rest % 10U));
        rest /= 10U;
    }
    return at + decimals;
}

char *line_put_string(char *at, const char *string)
{
    size_t length = strlen(string);
    memcpy(at, string, length);
    return at + length;
}

/* Appends the digit at *at to a number. False if there is none or the number gets above `max`. */
static bool read_digit(const char **at, const char *end, uint64_t max, uint64_t *value)
{
    if (*at == end || **at < '0' || **at > '9') {
        return false;
    }
    uint64_t digit = (uint64_t)(**at - '0');
    if (digit > max || *value > (max - digit) / 10U) {
        return false;
    }
    *value = *value * 10U + digit;
    (*at)++;
    return true;
}

static bool is_digit_at(const char *at, const char *end)
{
    return at != end && *at >= '0' && *at <= '9';
}

/* Appends digits, at least one and no more than `*room`. */
static bool read_digits(const char **at, const char *end, unsigned *room, uint64_t max, uint64_t *value)
{
    do {
        if (*room == 0 || !read_digit(at, end, max, value)) {
            return false;
        }
        (*room)--;
    } while (is_digit_at(*at, end));
    return true;
}

bool line_read_fixed(const char **at, const char *end, unsigned decimals, uint64_t max, uint64_t *value)
{
    unsigned any = UINT_MAX;
    *value = 0;
    if (!read_digits(at, end, &any, max, value)) {
        return false;
    }
    if (decimals > 0 && *at != end && **at == '.') {
        (*at)++;
        if (!read_digits(at, end, &decimals, max, value)) {
            return false;
        }
    }
    for (; decimals > 0; decimals--) {
        if (*value > max / 10U) {
            return false;
        }
        *value *= 10U;
    }
    return true;
}

bool line_read_hex(const char *at, const char *end, uint32_t *value)
{
    static const char digits[] = "0123456789abcdef";
    uint64_t number = 0;
    bool good = at != end && end - at <= HEX_DIGITS_MAX;
    for (; good && at != end; at++) {
        const char *digit = *at == '\0' ? NULL : strchr(digits, *at | 0x20);
        good = digit != NULL;
        number = number << 4 | (good ? (unsigned)(digit - digits) : 0U);
    }
    *value = (uint32_t)number;
    return good;
}
