#include <assert.h>

#include "gve_table.h"

const struct gve_words *gve_words(unsigned opcode)
{
    static const struct gve_words words[GVE_OPCODES] = {
#define X(name_, text, address, packet, states, least, p1, p2, p3, p4, p5, example_, answer_)                          \
    {.name = #name_, .example = (example_), .answer = (answer_)},
#include "gve_commands.def"
#undef X
    };
    assert(opcode < (unsigned)GVE_OPCODES);
    return &words[opcode];
}

const char *gve_kind_name(unsigned parameter)
{
    static const char *const names[GVE_PARAMETERS] = {
        "NONE",
#define P(name, form, min, max) #name,
#include "gve_commands.def"
#undef P
    };
    assert(parameter < (unsigned)GVE_PARAMETERS);
    return names[parameter];
}
