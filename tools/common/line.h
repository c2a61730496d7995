/*
 * Pieces of a line of text: whole and fixed-point numbers, both ways; exact, and fast enough for a line per pulse. Pure
 * functions.
 */
#ifndef LINE_H
#define LINE_H

#include <stdbool.h>
#include <stdint.h>

/* The longest number written here: 20 digits, a sign, a point. */
enum {
    LINE_NUMBER_BYTES_MAX = 24
};

/* Each writes a number at `at`, without a terminator, and returns where it ends. */
char *line_put_unsigned(char *at, uint64_t value);
char *line_put_signed(char *at, int64_t value);

/* value / 10^decimals with exactly that many decimals; decimals 1 to 18. */
char *line_put_fixed(char *at, uint64_t value, unsigned decimals);

/* Copies a string without its terminator. */
char *line_put_string(char *at, const char *string);

/* Reads digits, and if `decimals` is not 0 also a point with 1 to `decimals` digits after it, as a whole number of
 * units of 10^-decimals, and moves *at past it. False, with *at at the trouble, if there is no such number or it is
 * above `max`, which is at most 10^18. */
bool line_read_fixed(const char **at, const char *end, unsigned decimals, uint64_t max, uint64_t *value);

/* Reads one to eight hexadecimal digits, which go up to `end`. */
bool line_read_hex(const char *at, const char *end, uint32_t *value);

#endif
