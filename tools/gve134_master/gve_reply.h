/*
 * Commands and answers of the unit as they stand on the line, with a checksum or without. Pure; may be called from
 * anywhere.
 */
#ifndef GVE_REPLY_H
#define GVE_REPLY_H

#include <stdbool.h>
#include <stdint.h>

#include "base_text.h"
#include "gve_command.h"

enum {
    GVE_REPLY_LINE_BYTES_MAX = 127, /* what comes; what is longer is damage */
};

/* An answer. */
struct gve_reply {
    uint8_t code; /* enum gve_code, without GVE_INTA */
    bool inta;
    uint8_t length;                            /* of the values */
    char values[GVE_REPLY_LINE_BYTES_MAX + 1]; /* without the first comma; a zero after them */
};

/* What the values of an answer look like. */
enum gve_values {
    GVE_VALUES_NONE,
    GVE_VALUES_ANY,
    GVE_VALUES_VERSION, /* of this unit */
    GVE_VALUES_SOME,
    GVE_VALUES_NUMBER,         /* of at most three digits */
    GVE_VALUES_NUMBER_OR_NONE, /* the same, or nothing */
    GVE_VALUES_COUNT,          /* 0, or how many commands the packet had */
    GVE_VALUES_DECIMALS_2,
    GVE_VALUES_DECIMALS_3,
    GVE_VALUES_DECIMALS_4,
    GVE_VALUES_BYTE,
    GVE_VALUES_WORD,
    GVE_VALUES_SINGLE,
};

struct gve_reply_form {
    uint8_t values; /* enum gve_values */
    uint32_t count; /* for GVE_VALUES_COUNT */
};

/* Puts a command as files have it, such as H, c1,2 or !7V300: in capital letters, with its address, vectors with all
 * their four numbers, as a checksum is then never taken for one of them. */
void gve_reply_put_command(struct text *out, const uint8_t *text, uint32_t length, bool sums);

/* A command as files have it; and its opcode, GVE_OPCODES: there is no such command. */
struct gve_reading gve_reply_reading(const uint8_t *text, uint32_t length);
unsigned gve_reply_opcode(const uint8_t *text, uint32_t length);

/* What the answer to an opcode looks like where it is done. */
enum gve_values gve_reply_values(unsigned opcode);

/* Reads an answer without its CR. False: it is none, or its checksum is wrong. */
bool gve_reply_read(struct gve_reply *reply, const uint8_t *line, uint32_t length, bool sums);

/* Whether an answer can be one to what was asked; what was refused has no values, but packets. */
bool gve_reply_fits(const struct gve_reply *reply, struct gve_reply_form form);

/* The number of one that fits GVE_VALUES_NUMBER, the byte of one that fits GVE_VALUES_BYTE. */
uint32_t gve_reply_number(const struct gve_reply *reply);
unsigned gve_reply_byte(const struct gve_reply *reply);

#endif
