#include "gve_table.h"

#include <assert.h>

#define IS_USED(parameter) ((unsigned)GVE_PARAMETER_##parameter != (unsigned)GVE_PARAMETER_NONE ? 1U : 0U)

static const struct gve_row rows[GVE_OPCODES] = {
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

static const struct gve_kind kinds[GVE_PARAMETERS] = {
    {.form = GVE_FORM_DECIMAL},
#define P(name_, form_, min_, max_) {.min = (min_), .max = (max_), .form = GVE_FORM_##form_},
#include "gve_commands.def"
#undef P
};

#define X(name, text, address, packet, states, least, p1, p2, p3, p4, p5, example, answer)                             \
    static_assert(sizeof(states) == GVE_STATES + 1, #name " has a code for each state");
#include "gve_commands.def"
#undef X

const struct gve_row *gve_row(unsigned opcode)
{
    assert(opcode < (unsigned)GVE_OPCODES);
    return &rows[opcode];
}

const struct gve_kind *gve_kind(unsigned parameter)
{
    assert(parameter < (unsigned)GVE_PARAMETERS);
    return &kinds[parameter];
}

enum gve_code gve_refusal(unsigned opcode, enum gve_state state)
{
    return (enum gve_code)(gve_row(opcode)->states[state] - '0');
}
