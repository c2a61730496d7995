/*
 * The commands of a text, with their places.
 */
#ifndef LISTING_H
#define LISTING_H

#include <stdbool.h>
#include <stdint.h>

#include "program_instruction.h"
#include "program_listing.h"
#include "source.h"

struct listing_command {
    struct program_instruction instruction;
    uint32_t offset;
    uint32_t ordinal; /* in program memory, from 1; 0: not stored */
};

struct listing {
    struct listing_command *commands;
    uint32_t count;
    uint32_t start;  /* the first command after the last reset */
    uint32_t stored; /* commands that program memory keeps, if it has room for all */
};

/* Takes the commands of a text, without those in error. False after a complaint. */
bool listing_read(struct listing *listing, const struct source *text);

/* Writes the canonical text of a command, with a terminator. */
const char *listing_text(const struct listing_command *command, char text[PROGRAM_COMMAND_BYTES_MAX + 1]);

void listing_discard(struct listing *listing);

#endif
