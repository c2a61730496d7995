/*
 * The parser: program text in, instructions out, one at a time. The only parser of the project.
 *
 * Comes in: the bytes of a Set Command message or of a file. Goes out: instructions, or what is wrong and where. After
 * an error it can go on after the wrong command, so that a checker sees all errors of a text. Blanks, tabs, CR, LF and
 * { comments } between commands are skipped; all other rules are in the table of commands. A number of any length is
 * read whole and does not overflow. Memory: the struct. Pure; may be called from anywhere.
 */
#ifndef PROGRAM_PARSER_H
#define PROGRAM_PARSER_H

#include <stdint.h>

#include "program_instruction.h"

/* Numbers of internal variables, where a command takes inputs, too. */
enum {
    PROGRAM_VARIABLES = 16,
    PROGRAM_VARIABLE_FIRST = 80,
};

/* >0: nothing more, 0: an instruction, <0: an error. The unit's flags of Set Command are the negatives. */
enum program_status {
    PROGRAM_END = 1,
    PROGRAM_OK = 0,
    PROGRAM_BAD_VALUE = -1,       /* flag 1: the number after a command is missing, malformed or out of range */
    PROGRAM_UNKNOWN_COMMAND = -2, /* flag 2: no command has this character; also '{' of an unclosed comment */
};

struct program_parser {
    const uint8_t *text;
    uint32_t length; /* bytes */
    uint32_t next;   /* offset of the first byte not yet read */
    uint32_t place;  /* offset of the command found last, or of the one in error (its letter) */
};

void program_parser_init(struct program_parser *parser, const uint8_t *text, uint32_t length);

/* Finds the next command. On PROGRAM_OK `instruction` holds it; in any case `place` says where it stands. After an
 * error the next call goes on after the command letter and what looks like its value. */
enum program_status program_parser_next(struct program_parser *parser, struct program_instruction *instruction);

/* What a whole text is. */
struct program_summary {
    enum program_status status;       /* PROGRAM_OK, or the first error */
    uint8_t character;                /* with an error: the command letter, or the unknown character; else 0 */
    uint32_t commands;                /* number of commands, `\` included */
    struct program_instruction first; /* the first command, if there is one */
};

/* Reads a whole text without keeping it. */
struct program_summary program_check(const uint8_t *text, uint32_t length);

#endif
