/*
 * Program memory: the commands of one motor since its last reset, a ring of 700.
 *
 * Each command has an ordinal, counted from 0 at the first command after the last reset. When the ring is full the
 * oldest commands are overwritten, or, if locked, new ones are refused. At the last ordinal of 32 bits, weeks of
 * commands at the speed of the line, all are refused until the next reset. Main only. 4 kB: five bytes a command, as
 * RAM is what a board has least of.
 */
#ifndef PROGRAM_MEMORY_H
#define PROGRAM_MEMORY_H

#include <stdbool.h>
#include <stdint.h>

#include "program_instruction.h"

enum {
#ifdef RKM04_TINY_LIMITS
    PROGRAM_COMMANDS_MAX = 5,
#else
    PROGRAM_COMMANDS_MAX = 700,
#endif
    PROGRAM_LABEL_MAX = 80,
};

struct program_memory {
    int32_t value[PROGRAM_COMMANDS_MAX];         /* ring: of a conditional jump io * 256 + label, else the number */
    uint8_t opcode[PROGRAM_COMMANDS_MAX];        /* ring: enum program_opcode */
    uint32_t written;                            /* ordinal of the next command to be written */
    uint32_t released;                           /* ordinal of the youngest `]`, plus 1; 0: none */
    uint16_t label_place[PROGRAM_LABEL_MAX + 1]; /* per label: place of its youngest `@` in the ring, plus 1; 0: none */
};

/* Forgets all commands. */
void program_memory_clear(struct program_memory *memory);

/* Appends a command. False if the ring was full: the oldest command is lost, or with `locked` this one is. The value
 * of an `@` must be 1 to 80. */
bool program_memory_append(struct program_memory *memory, const struct program_instruction *instruction, bool locked);

/* The ordinals that are stored: from oldest to written - 1. */
uint32_t program_memory_oldest(const struct program_memory *memory);

/* The command with this ordinal, which must be stored. */
struct program_instruction program_memory_at(const struct program_memory *memory, uint32_t ordinal);

/* Finds the youngest `@label` (1 to 80) that is stored. False: there is none. */
bool program_memory_find_label(const struct program_memory *memory, uint32_t label, uint32_t *ordinal);

/* Whether a `]` has been written after the command with this ordinal. */
bool program_memory_is_released(const struct program_memory *memory, uint32_t ordinal);

/* Writes all stored commands in canonical form. Returns the length. A `capacity` of PROGRAM_COMMANDS_MAX *
 * PROGRAM_COMMAND_BYTES_MAX holds any memory; with less, the list ends where a longest command might not fit. */
uint32_t program_memory_list(const struct program_memory *memory, uint8_t *text, uint32_t capacity);

#endif
