/*
 * An instruction: a command of the language in fixed size, as program memory keeps it. 8 bytes.
 *
 * With it goes the table of the commands, program_opcodes.def, as data that the parser and the listing read. Pure; may
 * be called from anywhere.
 */
#ifndef PROGRAM_INSTRUCTION_H
#define PROGRAM_INSTRUCTION_H

#include <stdint.h>

enum program_opcode {
#define X(name, letter, form, min, max) PROGRAM_##name,
#include "program_opcodes.def"
#undef X
    PROGRAM_OPCODES
};

struct program_instruction {
    int32_t value;  /* the number, in the range of its row in the table; the label of a conditional jump; else 0 */
    uint8_t opcode; /* enum program_opcode */
    uint8_t io;     /* of a conditional jump: the input (1-8) or variable (80-95); else 0 */
};

/* What stands after a command letter; program_opcodes.def says what each is. */
enum program_form {
    PROGRAM_FORM_NONE,
    PROGRAM_FORM_NUMBER,
    PROGRAM_FORM_IO,
    PROGRAM_FORM_SIGNED,
    PROGRAM_FORM_PLUS,
    PROGRAM_FORM_MINUS,
    PROGRAM_FORM_HIGH,
    PROGRAM_FORM_LOW,
};

/* A row of the table. */
struct program_row {
    const char *name;
    int32_t min; /* smallest and largest number; both 0 where there is none */
    int32_t max;
    uint8_t letter;
    uint8_t form; /* enum program_form */
};

/* The row of an opcode, which must be below PROGRAM_OPCODES. */
const struct program_row *program_opcode_row(unsigned opcode);

/* The first opcode from `opcode` on that has this letter; PROGRAM_OPCODES if there is none. */
unsigned program_opcode_find(unsigned opcode, uint8_t letter);

/* The name of an opcode as in the table, for people and tools; empty where there is no such opcode. */
const char *program_opcode_name(uint8_t opcode);

#endif
