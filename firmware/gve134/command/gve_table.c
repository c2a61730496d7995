#include "gve_table.h"

#include <assert.h>

#define IS_USED(parameter) ((unsigned)GVE_PARAMETER_##parameter != (unsigned)GVE_PARAMETER_NONE ? 1U : 0U)

const struct gve_row gve_rows[GVE_OPCODES] = {
#define X(name_, text_, address_, packet_, states_, least_, p1, p2, p3, p4, p5, example_, answer_)                     \
    {                                                                                                                  \
        .text = (text_),                                                                                               \
        .states = (states_),                                                                                           \
        .parameters = {GVE_PARAMETER_##p1, GVE_PARAMETER_##p2, GVE_PARAMETER_##p3, GVE_PARAMETER_##p4,                 \
                       GVE_PARAMETER_##p5},                                                                            \
        .least = (least_),                                                                                             \
        .most = IS_USED(p1) + IS_USED(p2) + IS_USED(p3) + IS_USED(p4) + IS_USED(p5),                                   \
        .address = GVE_ADDRESS_##address_,                                                                             \
        .packet = GVE_PACKET_##packet_,                                                                                \
    },
#include "gve_commands.def"
#undef X
};

const struct gve_kind gve_kinds[GVE_PARAMETERS] = {
    {.form = GVE_FORM_DECIMAL},
#define P(name_, form_, min_, max_) {.min = (min_), .max = (max_), .form = GVE_FORM_##form_},
#include "gve_commands.def"
#undef P
};

#define X(name, text, address, packet, states, least, p1, p2, p3, p4, p5, example, answer)                             \
    static_assert(sizeof(states) == GVE_STATES + 1, #name " has a code for each state");
#include "gve_commands.def"
#undef X

enum {
    LETTER_MIN = '$',
    LETTERS = (unsigned)'Z' - (unsigned)LETTER_MIN + 1U,
};

#define FROM(letter, first_, last_) [(letter) - LETTER_MIN] = {.first = GVE_##first_, .past = GVE_##last_ + 1}
#define ONLY(letter, opcode) FROM(letter, opcode, opcode)

/* So that few rows are looked at. */
static const struct gve_opcodes of_letter[LETTERS] = {
    ONLY('$', SHORT),
    FROM('%', SUMS_ON, SUMS_OFF),
    FROM('*', PACKET_BEGIN, PACKET_END),
    ONLY('>', REPEAT),
    ONLY('?', VERSION),
    ONLY('@', INDEX),
    ONLY('A', ACCELERATION),
    ONLY('B', BRAKE),
    ONLY('C', CONTINUE),
    ONLY('D', DELETE),
    FROM('E', READ_BYTE, WRITE_SINGLE),
    ONLY('F', FLAGS),
    ONLY('G', GO),
    ONLY('H', HALT),
    FROM('I', INPUTS_1, INPUTS_2),
    ONLY('J', RESET),
    ONLY('K', KEEP),
    ONLY('L', LINE),
    FROM('N', ZERO, SET_POSITION),
    ONLY('O', OUTPUTS),
    FROM('P', POSITION_2, POSITION_LATCHED),
    ONLY('Q', SERIAL),
    ONLY('R', RESTORE),
    FROM('S', READ_STATUS, WRITE_STATUS),
    ONLY('T', PAUSE),
    FROM('V', SPEED, SPINDLE),
    ONLY('W', REFERENCE),
    FROM('X', CHANGE_ALL, CHANGE_TO),
};

struct gve_opcodes gve_opcodes_of(uint8_t character)
{
    uint32_t letter = (uint32_t)character - (uint32_t)LETTER_MIN;
    return letter < (uint32_t)LETTERS ? of_letter[letter] : (struct gve_opcodes){.first = 0};
}

enum gve_code gve_refusal(unsigned opcode, enum gve_state state)
{
    return (enum gve_code)(gve_row(opcode)->states[state] - '0');
}
