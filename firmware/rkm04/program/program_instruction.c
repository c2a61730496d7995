#include "program_instruction.h"

#include <assert.h>

static_assert(PROGRAM_OPCODES <= UINT8_MAX, "an instruction keeps its opcode in a byte");

static const struct program_row program_rows[PROGRAM_OPCODES] = {
#define X(name, letter, form, min, max) {#name, (min), (max), (letter), PROGRAM_FORM_##form},
#include "program_opcodes.def"
#undef X
};

const struct program_row *program_opcode_row(unsigned opcode)
{
    return &program_rows[opcode];
}

unsigned program_opcode_find(unsigned opcode, uint8_t letter)
{
    while (opcode < PROGRAM_OPCODES && program_rows[opcode].letter != letter) {
        opcode++;
    }
    return opcode;
}

const char *program_opcode_name(uint8_t opcode)
{
    return opcode < PROGRAM_OPCODES ? program_opcode_row(opcode)->name : "";
}
