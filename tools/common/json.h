/*
 * What JSON needs on standard output besides printf.
 */
#ifndef JSON_H
#define JSON_H

#include <stddef.h>
#include <stdint.h>

/* Prints a quoted string with escapes; bytes from 80 on are taken for code points. */
void json_print_text(const char *text, size_t length);
void json_print_string(const char *string);

/* Prints a quoted string that is UTF-8. */
void json_print_utf8(const char *string);

/* Prints value / 10^decimals with that many decimals. */
void json_print_fixed(uint64_t value, unsigned decimals);

#endif
