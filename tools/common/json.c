#include "json.h"

#include <stdio.h>
#include <string.h>

#include "line.h"

void json_print_text(const char *text, size_t length)
{
    (void)putchar('"');
    for (size_t i = 0; i < length; i++) {
        unsigned char byte = (unsigned char)text[i];
        if (byte < 0x20 || byte >= 0x7F) {
            (void)printf("\\u%04x", (unsigned)byte);
        } else if (byte == '"' || byte == '\\') {
            (void)printf("\\%c", byte);
        } else {
            (void)putchar(byte);
        }
    }
    (void)putchar('"');
}

void json_print_string(const char *string)
{
    json_print_text(string, strlen(string));
}

void json_print_utf8(const char *string)
{
    (void)putchar('"');
    for (; *string != '\0'; string++) {
        unsigned char byte = (unsigned char)*string;
        if (byte < 0x20 || byte == 0x7F) {
            (void)printf("\\u%04x", (unsigned)byte);
            continue;
        }
        if (byte == '"' || byte == '\\') {
            (void)putchar('\\');
        }
        (void)putchar(byte);
    }
    (void)putchar('"');
}

void json_print_fixed(uint64_t value, unsigned decimals)
{
    char text[LINE_NUMBER_BYTES_MAX];
    const char *end = line_put_fixed(text, value, decimals);
    (void)fwrite(text, 1, (size_t)(end - text), stdout);
}
