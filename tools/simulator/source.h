/*
 * A program file as characters: UTF-8 in, one byte for each character out, as the unit gets them, and back to line and
 * column. So an offset that the parser reports is the number of a character.
 */
#ifndef SOURCE_H
#define SOURCE_H

#include <stdbool.h>
#include <stdint.h>

#include "infile.h"

struct source {
    uint32_t *characters; /* code points; one of 0 stands after the last */
    uint8_t *message;     /* the same as the unit gets them: 0xFF for what it cannot know */
    uint32_t length;
};

/* Line and column of a character, both from 1; moved forward only. */
struct source_place {
    uint32_t offset;
    uint32_t line;
    uint32_t column;
};

/* False after a complaint. */
bool source_read(struct source *text, const struct infile *file);

struct source_place source_begin(void);

/* Moves a place to an offset that is not before it. */
void source_move(const struct source *text, struct source_place *place, uint32_t offset);

/* Whether a line ends with the character at an offset; the end of the text ends one. */
bool source_is_line_end(const struct source *text, uint32_t offset);

/* Characters of the command at an offset, with what looks like its value; of a comment all that its line has. */
uint32_t source_command_width(const struct source *text, uint32_t offset);

/* Where what looks like the value of the command at an offset ends; for I a condition, as in I05H10. */
uint32_t source_value_end(const struct source *text, uint32_t offset);

void source_discard(struct source *text);

#endif
