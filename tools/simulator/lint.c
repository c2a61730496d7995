#include "lint.h"

#include <stdlib.h>

#include "program_memory.h"

enum {
    LOOPS_MAX = 8,
    SIMULATION = 41, /* the function */
};

void lint_add(struct problems *problems, const struct listing_command *command, const char *rule, const char *words)
{
    char text[PROGRAM_COMMAND_BYTES_MAX + 1];
    problems_add(problems, command->offset, 0, rule, "%s%s", listing_text(command, text), words);
}

static void find_lost(const struct listing *listing, struct problems *problems)
{
    for (uint32_t i = 0; i + 1U < listing->start; i++) {
        if (listing->commands[i].instruction.opcode != PROGRAM_RESET) {
            problems_add(problems, listing->commands[listing->start - 1U].offset, 0, "lost",
                         "\\ clears all that stands before it; nothing of it runs");
            return;
        }
    }
}

static void find_labels(const struct flow *flow, struct problems *problems)
{
    bool is_seen[FLOW_LABELS] = {false};
    for (uint32_t i = 0; i < flow->count; i++) {
        unsigned opcode = flow_opcode(flow, i);
        unsigned label = flow_label(flow, i);
        if (opcode == PROGRAM_LABEL) {
            if (is_seen[label]) {
                problems_add(problems, flow->commands[i].offset, 0, "duplicate-label",
                             "label %u is defined again; only its last place counts", label);
            }
            is_seen[label] = true;
        } else if ((flow_is_jump(opcode) || opcode == PROGRAM_CALL) && flow->label[label] == FLOW_NONE) {
            problems_add(problems, flow->commands[i].offset, 0, "missing-label",
                         "there is no label %u (@%u) in this file", label, label);
        }
    }
}

/* With room for all commands that may be open. */
static void find_loops_with(const struct flow *flow, struct problems *problems, uint32_t *opened)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < flow->count; i++) {
        unsigned opcode = flow_opcode(flow, i);
        if (opcode == PROGRAM_LOOP) {
            opened[count++] = i;
            if (count == LOOPS_MAX + 1) {
                problems_add(problems, flow->commands[i].offset, 0, "loop-depth",
                             "this loop is nested too deeply; at most %d can be open", LOOPS_MAX);
            }
        } else if (opcode == PROGRAM_LOOP_END && count == 0) {
            problems_add(problems, flow->commands[i].offset, 0, "loop-end", "E without an L before it");
        } else if (opcode == PROGRAM_LOOP_END) {
            count--;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        lint_add(problems, &flow->commands[opened[i]], "loop-open", " without an E after it");
    }
}

static void find_loops(const struct flow *flow, struct problems *problems)
{
    uint32_t *opened = calloc((size_t)flow->count + 1U, sizeof *opened);
    if (opened == NULL) {
        problems->is_short = true;
        return;
    }
    find_loops_with(flow, problems, opened);
    free(opened);
}

struct sections {
    bool are_run; /* by the next R: it runs a compound move */
    bool are_new; /* none has run them yet */
};

static void follow_sections(struct sections *sections, unsigned opcode)
{
    if (opcode == PROGRAM_APPEND_SECTION) {
        sections->are_run = true;
        sections->are_new = true;
    } else if (opcode == PROGRAM_MOVE) {
        sections->are_new = false;
    } else if (opcode == PROGRAM_STEPS_FORWARD || opcode == PROGRAM_STEPS_BACKWARD) {
        sections->are_run = sections->are_new;
    }
}

/* Of a single move: of a compound move, V says nothing but how fast its sections are at the most. */
static bool needs_speed(unsigned opcode, const struct sections *sections)
{
    return (opcode == PROGRAM_MOVE && !sections->are_run) || opcode == PROGRAM_GO_TO || opcode == PROGRAM_GO_HOME ||
           opcode == PROGRAM_RUN_FORWARD || opcode == PROGRAM_RUN_BACKWARD;
}

static void add_speed(struct problems *problems, const struct listing_command *slow,
                      const struct listing_command *start)
{
    char speed[PROGRAM_COMMAND_BYTES_MAX + 1];
    char from[PROGRAM_COMMAND_BYTES_MAX + 1];
    uint32_t offset = slow->offset > start->offset ? slow->offset : start->offset;
    (void)listing_text(slow, speed);
    problems_add(problems, offset, 0, "speed", "%s is below %s; the move runs at %s throughout", speed,
                 listing_text(start, from), speed);
}

static bool is_below(const struct listing_command *slow, const struct listing_command *start)
{
    return slow != NULL && start != NULL && slow->instruction.value < start->instruction.value;
}

/* A maximum speed below the start/stop speed when a single move, or the end, comes. */
static void find_speeds(const struct flow *flow, struct problems *problems)
{
    const struct listing_command *slow = NULL;
    const struct listing_command *start = NULL;
    struct sections sections = {.are_run = false};
    bool is_told = false;
    for (uint32_t i = 0; i <= flow->count; i++) {
        unsigned opcode = i < flow->count ? flow_opcode(flow, i) : PROGRAM_MOVE;
        follow_sections(&sections, opcode);
        if (opcode == PROGRAM_SPEED || opcode == PROGRAM_START_SPEED) {
            *(opcode == PROGRAM_SPEED ? &slow : &start) = &flow->commands[i];
            is_told = false;
        } else if (needs_speed(opcode, &sections) && !is_told && is_below(slow, start)) {
            add_speed(problems, slow, start);
            is_told = true;
        }
    }
}

static bool is_simulation(const struct flow *flow, uint32_t index)
{
    unsigned opcode = flow_opcode(flow, index);
    bool is_switch = opcode == PROGRAM_FUNCTION_ON || opcode == PROGRAM_FUNCTION_OFF;
    return is_switch && flow->commands[index].instruction.value == SIMULATION;
}

static void find_simulation(const struct flow *flow, struct problems *problems)
{
    uint32_t switches = 0;
    for (uint32_t i = 0; i < flow->count; i++) {
        switches += is_simulation(flow, i) ? 1U : 0U;
    }
    for (uint32_t i = 0; switches < flow->count && i < flow->count; i++) {
        if (is_simulation(flow, i)) {
            lint_add(
                problems, &flow->commands[i], "simulation",
                " inside a program switches the outputs at once, and every motor of the unit where it next stands");
        }
    }
}

static void find_ignored(const struct flow *flow, struct problems *problems)
{
    for (uint32_t i = 0; flow->count > 1 && i < flow->count; i++) {
        unsigned opcode = flow_opcode(flow, i);
        if (opcode == PROGRAM_HALT || opcode == PROGRAM_RESUME) {
            lint_add(problems, &flow->commands[i], "ignored", " inside a program is ignored; it must be sent alone");
        }
    }
}

static void find_too_many(const struct flow *flow, struct problems *problems)
{
    for (uint32_t i = 0; i < flow->count; i++) {
        if (flow->commands[i].ordinal == PROGRAM_COMMANDS_MAX + 1U) {
            problems_add(problems, flow->commands[i].offset, 0, "too-many",
                         "program memory holds %d commands; from here on the oldest ones are lost",
                         PROGRAM_COMMANDS_MAX);
        }
    }
}

static void find_all(const struct flow *flow, struct problems *problems)
{
    find_labels(flow, problems);
    find_loops(flow, problems);
    lint_find_paths(flow, problems);
    find_speeds(flow, problems);
    find_simulation(flow, problems);
    find_ignored(flow, problems);
    find_too_many(flow, problems);
    lint_find_compounds(flow, problems);
}

void lint_find(const struct listing *listing, struct problems *problems)
{
    if (listing->count == 0) {
        problems_add(problems, 0, 0, "empty", "there is no command in this file");
        return;
    }
    find_lost(listing, problems);
    struct flow flow;
    if (flow_read(&flow, listing)) {
        find_all(&flow, problems);
    } else {
        problems->is_short = true;
    }
    flow_discard(&flow);
}
