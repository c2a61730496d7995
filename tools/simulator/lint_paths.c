/* What the paths through a program show. */
#include "lint.h"

#include <stdlib.h>
#include <string.h>

enum {
    CALLS_MAX = 6
};

static void mark_all(const struct flow *flow, uint8_t *set, unsigned opcode)
{
    for (uint32_t i = 0; i < flow->count; i++) {
        set[i] |= flow_opcode(flow, i) == opcode ? 1U : 0U;
    }
}

/* Loops of subroutines that only a `.` ends. */
static void find_returned_loops(const struct flow *flow, struct problems *problems, uint8_t *returns, uint8_t *closes)
{
    mark_all(flow, returns, PROGRAM_RETURN);
    flow_spread_back_inside(flow, returns);
    mark_all(flow, closes, PROGRAM_LOOP_END);
    flow_spread_back_inside(flow, closes);
    for (uint32_t i = 0; i + 1U < flow->count; i++) {
        bool is_own = flow->run[i] != 0 && flow->main[i] == 0 && flow_opcode(flow, i) == PROGRAM_LOOP;
        if (is_own && returns[i + 1U] != 0 && closes[i + 1U] == 0) {
            char text[PROGRAM_COMMAND_BYTES_MAX + 1];
            problems_add(problems, flow->commands[i].offset, 0, "loop-returned",
                         "the . after it closes %s; an E after the call is not its own",
                         listing_text(&flow->commands[i], text));
        }
    }
}

/* Marks the labels that are called by the commands of a set. */
static void mark_called(const struct flow *flow, const uint8_t *set, bool called[FLOW_LABELS])
{
    for (uint32_t i = 0; set != NULL && i < flow->count; i++) {
        unsigned label = set[i] != 0 && flow_opcode(flow, i) == PROGRAM_CALL ? flow_label(flow, i) : 0;
        called[label] = called[label] || flow->label[label] != FLOW_NONE;
    }
}

/* Calls that can be more than six deep, recursion among them. */
static void find_calls(const struct flow *flow, struct problems *problems)
{
    bool level[FLOW_LABELS] = {false};
    mark_called(flow, flow->main, level);
    for (unsigned depth = 1; depth <= CALLS_MAX; depth++) {
        bool deeper[FLOW_LABELS] = {false};
        for (unsigned label = 1; label < FLOW_LABELS; label++) {
            mark_called(flow, level[label] ? flow->subroutine[label] : NULL, deeper);
        }
        memcpy(level, deeper, sizeof level);
    }
    for (uint32_t i = 0; i < flow->count; i++) {
        if (flow_opcode(flow, i) == PROGRAM_CALL && level[flow_label(flow, i)]) {
            problems_add(problems, flow->commands[i].offset, 0, "call-depth", "calls can become more than %d deep here",
                         CALLS_MAX);
            return;
        }
    }
}

static void find_returns(const struct flow *flow, struct problems *problems)
{
    for (uint32_t i = 0; i < flow->count; i++) {
        if (flow->main[i] != 0 && flow_opcode(flow, i) == PROGRAM_RETURN) {
            problems_add(problems, flow->commands[i].offset, 0, "return", "the program comes to this . without a call");
        }
    }
}

/* Stretches that never run. A ] releases without being run. */
static void find_unreachable(const struct flow *flow, struct problems *problems)
{
    bool was_dead = false;
    for (uint32_t i = 0; i < flow->count; i++) {
        bool is_dead = flow->run[i] == 0 && flow_opcode(flow, i) != PROGRAM_RELEASE;
        if (is_dead && !was_dead) {
            lint_add(problems, &flow->commands[i], "unreachable", " is never reached");
        }
        was_dead = is_dead;
    }
}

struct search {
    uint8_t *reported; /* commands of loops that were told */
    uint8_t *seen;
    uint32_t *todo;
    uint32_t *came_from;
};

/* The last command of a shortest way from a command back to itself that takes no time; FLOW_NONE: there is none. */
static int64_t find_cycle(const struct flow *flow, const struct search *search, uint32_t start)
{
    uint32_t done = 0;
    uint32_t count = 0;
    memset(search->seen, 0, flow->count);
    search->todo[count++] = start;
    while (done < count) {
        uint32_t index = search->todo[done++];
        uint32_t next[FLOW_NEXT_MAX];
        unsigned found = flow_next_at_once(flow, index, next);
        for (unsigned i = 0; i < found; i++) {
            if (next[i] == start) {
                return index;
            }
            if (search->seen[next[i]] == 0) {
                search->seen[next[i]] = 1;
                search->came_from[next[i]] = index;
                search->todo[count++] = next[i];
            }
        }
    }
    return FLOW_NONE;
}

/* Goes back along a cycle; whether all of it is new and, if so, whether it asks for inputs or variables. */
static bool report_cycle(const struct flow *flow, const struct search *search, uint32_t start, uint32_t last,
                         bool *polls)
{
    uint32_t at = last;
    bool is_new = search->reported[start] == 0;
    *polls = false;
    while (at != start) {
        unsigned opcode = flow_opcode(flow, at);
        is_new = is_new && search->reported[at] == 0;
        *polls = *polls || opcode == PROGRAM_JUMP_IF_HIGH || opcode == PROGRAM_JUMP_IF_LOW;
        at = search->came_from[at];
    }
    search->reported[start] |= is_new ? 1U : 0U;
    for (at = last; is_new && at != start; at = search->came_from[at]) {
        search->reported[at] = 1;
    }
    return is_new;
}

static void find_busy_loops(const struct flow *flow, struct problems *problems, const struct search *search)
{
    for (uint32_t start = 0; start < flow->count; start++) {
        unsigned label = flow_opcode(flow, start) == PROGRAM_LABEL ? flow_label(flow, start) : 0;
        if (label == 0 || flow->label[label] != start || flow->run[start] == 0) {
            continue;
        }
        bool polls = false;
        int64_t last = find_cycle(flow, search, start);
        if (last != FLOW_NONE && report_cycle(flow, search, start, (uint32_t)last, &polls)) {
            problems_add(problems, flow->commands[last].offset, 0, "busy-loop",
                         "the loop from here back to label %u never waits, the program is busy; %s", label,
                         polls ? "wait for an input with O or Z, or pause with W" : "pause with W");
        }
    }
}

/* The first R and Y to which no way leads from any F or B. */
static void find_no_steps(const struct flow *flow, struct problems *problems, uint8_t *reached)
{
    mark_all(flow, reached, PROGRAM_STEPS_FORWARD);
    mark_all(flow, reached, PROGRAM_STEPS_BACKWARD);
    flow_spread(flow, reached);
    bool move = false;
    bool section = false;
    for (uint32_t i = 0; i < flow->count; i++) {
        unsigned opcode = flow->run[i] != 0 && reached[i] == 0 ? flow_opcode(flow, i) : PROGRAM_OPCODES;
        if (opcode == PROGRAM_MOVE && !move) {
            problems_add(problems, flow->commands[i].offset, 0, "no-steps", "R before any F or B does nothing");
        } else if (opcode == PROGRAM_APPEND_SECTION && !section) {
            problems_add(problems, flow->commands[i].offset, 0, "no-steps", "Y before any F or B");
        }
        move = move || opcode == PROGRAM_MOVE;
        section = section || opcode == PROGRAM_APPEND_SECTION;
    }
}

static bool takes_time(unsigned opcode)
{
    return flow_waits(opcode) || opcode == PROGRAM_HOLD;
}

/* An X after which the program only comes to rest. */
static void find_total_stops(const struct flow *flow, struct problems *problems, uint8_t *leads)
{
    bool is_any = false;
    for (uint32_t i = 0; i < flow->count; i++) {
        leads[i] = takes_time(flow_opcode(flow, i)) ? 1U : 0U;
        is_any = is_any || leads[i] != 0;
    }
    flow_spread_back(flow, leads);
    for (uint32_t i = 0; is_any && i < flow->count; i++) {
        if (flow_opcode(flow, i) == PROGRAM_TOTAL_STOP && flow->run[i] != 0 && leads[i] == 0) {
            lint_add(problems, &flow->commands[i], "total-stop",
                     " does nothing while the motor rests; put it before the moves");
        }
    }
}

enum {
    SETS = 4
};

/* With sets of no commands. */
static void find_with(const struct flow *flow, struct problems *problems, const struct search *search,
                      uint8_t *const sets[SETS])
{
    find_returned_loops(flow, problems, sets[0], sets[1]);
    find_calls(flow, problems);
    find_returns(flow, problems);
    find_unreachable(flow, problems);
    find_busy_loops(flow, problems, search);
    find_no_steps(flow, problems, sets[2]);
    find_total_stops(flow, problems, sets[3]);
}

void lint_find_paths(const struct flow *flow, struct problems *problems)
{
    struct search search = {
        .reported = flow_new_set(flow),
        .seen = flow_new_set(flow),
        .todo = calloc((size_t)flow->count + 1U, sizeof *search.todo),
        .came_from = calloc((size_t)flow->count + 1U, sizeof *search.came_from),
    };
    bool is_short = search.reported == NULL || search.seen == NULL || search.todo == NULL || search.came_from == NULL;
    uint8_t *sets[SETS];
    for (unsigned i = 0; i < SETS; i++) {
        sets[i] = flow_new_set(flow);
        is_short = is_short || sets[i] == NULL;
    }
    if (!is_short) {
        find_with(flow, problems, &search, sets);
    }
    problems->is_short = problems->is_short || is_short;
    free(search.reported);
    free(search.seen);
    free(search.todo);
    free(search.came_from);
    for (unsigned i = 0; i < SETS; i++) {
        free(sets[i]);
    }
}
