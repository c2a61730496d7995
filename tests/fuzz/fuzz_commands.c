#include "fuzz_commands.h"

#include <stdbool.h>

#include "fuzz_stream.h"
#include "program_listing.h"

enum {
    SMALL_NUMBERS = 20
};

/* The seed's digits, one after the other. */
static unsigned draw(unsigned *seed, unsigned count)
{
    unsigned drawn = *seed % count;
    *seed /= count;
    return drawn;
}

static int32_t draw_value(const struct program_row *row, unsigned *seed)
{
    int64_t range = (int64_t)row->max - row->min + 1;
    switch (draw(seed, 4)) {
    case 0:
        return row->min;
    case 1:
        return row->max;
    default:
        return (int32_t)(row->min + (int64_t)draw(seed, SMALL_NUMBERS) % range);
    }
}

size_t fuzz_insert_command(uint8_t *data, size_t size, size_t max_size, size_t head, unsigned seed)
{
    uint8_t text[PROGRAM_COMMAND_BYTES_MAX];
    const unsigned opcode = draw(&seed, PROGRAM_OPCODES);
    const struct program_row *row = program_opcode_row(opcode);
    bool conditional = row->form == PROGRAM_FORM_HIGH || row->form == PROGRAM_FORM_LOW;
    struct program_instruction instruction = {
        .opcode = (uint8_t)opcode,
        .value = draw_value(row, &seed),
        .io = conditional ? (uint8_t)(80U + draw(&seed, 16)) : 0,
    };
    uint32_t length = program_list_instruction(&instruction, text);
    if (draw(&seed, 8) == 0 && text[length - 1] >= '0' && text[length - 1] < '9') {
        text[length - 1]++;
    }
    return fuzz_insert(data, size, max_size, head, seed, text, length);
}
