/*
 * The listing: instructions back into canonical text: no blanks, no comments, no leading zeros except that numbers of
 * inputs, outputs and variables have two digits. What the parser makes of it is the same instruction. Pure.
 */
#ifndef PROGRAM_LISTING_H
#define PROGRAM_LISTING_H

#include <stdint.h>

#include "program_instruction.h"

/* The longest command: "=-2000000000". */
enum {
    PROGRAM_COMMAND_BYTES_MAX = 12
};

/* Writes the text of an instruction that the parser could have made (no terminator) and returns its length. */
uint32_t program_list_instruction(const struct program_instruction *instruction,
                                  uint8_t text[PROGRAM_COMMAND_BYTES_MAX]);

#endif
