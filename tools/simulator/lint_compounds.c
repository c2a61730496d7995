/* What is wrong with compound moves, as a reader of the text sees them. */
#include "lint.h"

#include <stddef.h>

enum {
    SECTIONS_MAX = 10,
    MARK_MIN = 51, /* functions that set an output when the last section begins */
    MARK_MAX = 58,
    MARKS = MARK_MAX - MARK_MIN + 1,
};

struct compound {
    const struct listing_command *off[MARKS]; /* functions that were on at the first Y and are not any more */
    uint32_t sections;
    bool on[MARKS];
    bool backward;
    bool direction; /* of the first section */
    bool done;
};

static void forget_off(struct compound *compound)
{
    for (unsigned i = 0; i < MARKS; i++) {
        compound->off[i] = NULL;
    }
}

static void turn(struct compound *compound, bool backward)
{
    compound->backward = backward;
    if (compound->done) {
        compound->sections = 0;
        compound->done = false;
    }
}

static void append(struct compound *compound, const struct listing_command *command, struct problems *problems)
{
    if (compound->done || compound->sections == 0) {
        compound->sections = 0;
        compound->done = false;
        compound->direction = compound->backward;
        forget_off(compound);
    }
    compound->sections++;
    if (compound->backward != compound->direction) {
        problems_add(problems, command->offset, 0, "direction", "the direction changes inside a compound move");
    }
    if (compound->sections == SECTIONS_MAX + 1) {
        problems_add(problems, command->offset, 0, "sections", "a compound move has at most %d sections", SECTIONS_MAX);
    }
}

static void run(struct compound *compound, struct problems *problems)
{
    compound->done = compound->sections > 0;
    for (unsigned i = 0; i < MARKS && compound->done; i++) {
        if (compound->off[i] != NULL) {
            lint_add(problems, compound->off[i], "mark-off",
                     " stands before an R of this compound move; its output is not set");
        }
    }
    if (compound->done) {
        forget_off(compound);
    }
}

static void switch_mark(struct compound *compound, const struct listing_command *command, struct problems *problems)
{
    unsigned mark = (unsigned)(command->instruction.value - MARK_MIN);
    if (command->instruction.opcode == PROGRAM_FUNCTION_ON) {
        if (compound->off[mark] == NULL && compound->sections > 0 && !compound->done) {
            lint_add(problems, command, "mark", " does not act on this compound move; put it before the first Y");
        }
        compound->on[mark] = true;
        compound->off[mark] = NULL;
    } else if (compound->on[mark]) {
        compound->on[mark] = false;
        compound->off[mark] = compound->sections > 0 ? command : compound->off[mark];
    }
}

static bool is_mark(const struct listing_command *command)
{
    return command->instruction.value >= MARK_MIN && command->instruction.value <= MARK_MAX;
}

static void take(struct compound *compound, const struct listing_command *command, struct problems *problems)
{
    switch (command->instruction.opcode) {
    case PROGRAM_STEPS_FORWARD:
    case PROGRAM_STEPS_BACKWARD:
        turn(compound, command->instruction.opcode == PROGRAM_STEPS_BACKWARD);
        break;
    case PROGRAM_REVERSE:
        compound->backward = !compound->backward;
        break;
    case PROGRAM_MOVE:
        run(compound, problems);
        break;
    case PROGRAM_APPEND_SECTION:
        append(compound, command, problems);
        break;
    case PROGRAM_FUNCTION_ON:
    case PROGRAM_FUNCTION_OFF:
        if (is_mark(command)) {
            switch_mark(compound, command, problems);
        }
        break;
    default:
        break;
    }
}

void lint_find_compounds(const struct flow *flow, struct problems *problems)
{
    struct compound compound = {.sections = 0};
    for (uint32_t i = 0; i < flow->count; i++) {
        take(&compound, &flow->commands[i], problems);
    }
}
