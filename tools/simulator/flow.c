#include "flow.h"

#include <stdlib.h>

/*
 * Sets grow until they grow no more. A pass in the direction of the paths settles all but the jumps the other way, and
 * those lead to labels or out of subroutines only: so there are few passes, however long the program is.
 */

unsigned flow_opcode(const struct flow *flow, uint32_t index)
{
    return flow->commands[index].instruction.opcode;
}

unsigned flow_label(const struct flow *flow, uint32_t index)
{
    int32_t value = flow->commands[index].instruction.value;
    return value > 0 && value < FLOW_LABELS ? (unsigned)value : 0;
}

bool flow_is_jump(unsigned opcode)
{
    return opcode == PROGRAM_JUMP || opcode == PROGRAM_JUMP_IF_HIGH || opcode == PROGRAM_JUMP_IF_LOW;
}

static bool is_endless_run(unsigned opcode)
{
    return opcode == PROGRAM_RUN_FORWARD || opcode == PROGRAM_RUN_BACKWARD;
}

bool flow_waits(unsigned opcode)
{
    switch (opcode) {
    case PROGRAM_RUN_FORWARD:
    case PROGRAM_RUN_BACKWARD:
    case PROGRAM_MOVE:
    case PROGRAM_GO_TO:
    case PROGRAM_GO_HOME:
    case PROGRAM_LIMIT_FORWARD:
    case PROGRAM_LIMIT_BACKWARD:
    case PROGRAM_WAIT:
    case PROGRAM_WAIT_INPUT_HIGH:
    case PROGRAM_WAIT_INPUT_LOW:
    case PROGRAM_WAIT_VARIABLE_HIGH:
    case PROGRAM_WAIT_VARIABLE_LOW:
        return true;
    default:
        return false;
    }
}

/* Whether the flow never goes on after a command. */
static bool ends_here(const struct flow *flow, unsigned opcode)
{
    return opcode == PROGRAM_JUMP || opcode == PROGRAM_RETURN || (is_endless_run(opcode) && !flow->has_guards);
}

/* Where a command may lead, a call to the command after it; and whether it is one at all is not asked. */
static unsigned next_of(const struct flow *flow, uint32_t index, uint32_t next[FLOW_NEXT_MAX])
{
    unsigned opcode = flow_opcode(flow, index);
    int64_t target = flow->label[flow_label(flow, index)];
    unsigned count = 0;
    if (flow_is_jump(opcode) && target != FLOW_NONE) {
        next[count++] = (uint32_t)target;
    }
    if (!ends_here(flow, opcode) && index + 1U < flow->count) {
        next[count++] = index + 1U;
    }
    return count;
}

unsigned flow_next(const struct flow *flow, uint32_t index, uint32_t next[FLOW_NEXT_MAX])
{
    bool passes = flow_opcode(flow, index) != PROGRAM_CALL || flow->ends[flow_label(flow, index)];
    return passes ? next_of(flow, index, next) : 0;
}

unsigned flow_next_at_once(const struct flow *flow, uint32_t index, uint32_t next[FLOW_NEXT_MAX])
{
    unsigned opcode = flow_opcode(flow, index);
    bool passes = opcode != PROGRAM_CALL || flow->ends_at_once[flow_label(flow, index)];
    return passes && !flow_waits(opcode) ? flow_next(flow, index, next) : 0;
}

unsigned flow_next_inside(const struct flow *flow, uint32_t index, uint32_t next[FLOW_NEXT_MAX])
{
    unsigned count = flow_next(flow, index, next);
    int64_t target = flow->label[flow_label(flow, index)];
    if (flow_opcode(flow, index) == PROGRAM_CALL && target != FLOW_NONE) {
        next[count++] = (uint32_t)target;
    }
    return count;
}

uint8_t *flow_new_set(const struct flow *flow)
{
    return calloc((size_t)flow->count + 1U, 1);
}

typedef unsigned next_function(const struct flow *flow, uint32_t index, uint32_t next[FLOW_NEXT_MAX]);

/* Adds a command; whether it is new. */
static bool add(uint8_t *set, uint32_t index)
{
    bool is_new = set[index] == 0;
    set[index] = 1;
    return is_new;
}

/* One pass; whether the set has grown. */
static bool grow(const struct flow *flow, uint8_t *set, next_function *next_after)
{
    bool has_grown = false;
    for (uint32_t i = 0; i < flow->count; i++) {
        uint32_t next[FLOW_NEXT_MAX];
        for (unsigned left = set[i] != 0 ? next_after(flow, i, next) : 0; left > 0; left--) {
            has_grown = add(set, next[left - 1U]) || has_grown;
        }
    }
    return has_grown;
}

static bool grow_back(const struct flow *flow, uint8_t *set, next_function *next_after)
{
    bool has_grown = false;
    for (uint32_t i = flow->count; i-- > 0;) {
        uint32_t next[FLOW_NEXT_MAX];
        for (unsigned left = set[i] == 0 ? next_after(flow, i, next) : 0; left > 0; left--) {
            has_grown = (set[next[left - 1U]] != 0 && add(set, i)) || has_grown;
        }
    }
    return has_grown;
}

/* The label of a call after which there is a command; 0: it is none. */
static unsigned call_label(const struct flow *flow, uint32_t index)
{
    bool is_call = flow_opcode(flow, index) == PROGRAM_CALL && index + 1U < flow->count;
    return is_call ? flow_label(flow, index) : 0;
}

/* Whether a command is an end of the subroutine of a label. */
static bool is_end_of(const struct flow *flow, uint32_t index, unsigned label)
{
    const uint8_t *own = flow->subroutine[label];
    return own != NULL && own[index] != 0 && flow_opcode(flow, index) == PROGRAM_RETURN;
}

/* From ends of subroutines to what comes after their calls; whether the set has grown. */
static bool return_to_calls(const struct flow *flow, uint8_t *set)
{
    bool returns[FLOW_LABELS] = {false};
    for (uint32_t i = 0; i < flow->count; i++) {
        for (unsigned label = 1; label < FLOW_LABELS && set[i] != 0; label++) {
            returns[label] = returns[label] || is_end_of(flow, i, label);
        }
    }
    bool has_grown = false;
    for (uint32_t i = 0; i < flow->count; i++) {
        has_grown = (returns[call_label(flow, i)] && add(set, i + 1U)) || has_grown;
    }
    return has_grown;
}

/* The other way. */
static bool return_back(const struct flow *flow, uint8_t *set)
{
    bool returns[FLOW_LABELS] = {false};
    for (uint32_t i = 0; i < flow->count; i++) {
        unsigned label = call_label(flow, i);
        returns[label] = returns[label] || (label != 0 && set[i + 1U] != 0);
    }
    bool has_grown = false;
    for (uint32_t i = 0; i < flow->count; i++) {
        for (unsigned label = 1; label < FLOW_LABELS; label++) {
            has_grown = (returns[label] && is_end_of(flow, i, label) && add(set, i)) || has_grown;
        }
    }
    return has_grown;
}

void flow_spread(const struct flow *flow, uint8_t *set)
{
    while (grow(flow, set, flow_next_inside) || return_to_calls(flow, set)) {
    }
}

void flow_spread_back(const struct flow *flow, uint8_t *set)
{
    while (grow_back(flow, set, flow_next_inside) || return_back(flow, set)) {
    }
}

void flow_spread_back_inside(const struct flow *flow, uint8_t *set)
{
    while (grow_back(flow, set, flow_next)) {
    }
}

static void find_places(struct flow *flow)
{
    for (unsigned label = 0; label < FLOW_LABELS; label++) {
        flow->label[label] = FLOW_NONE;
    }
    for (uint32_t i = 0; i < flow->count; i++) {
        unsigned opcode = flow_opcode(flow, i);
        flow->has_guards = flow->has_guards || opcode == PROGRAM_GUARD_HIGH || opcode == PROGRAM_GUARD_LOW;
        if (opcode == PROGRAM_LABEL) {
            flow->label[flow_label(flow, i)] = i;
        }
    }
}

/* Whether a command may lead to the end of its subroutine, by one of those that do. */
static bool may_end(const struct flow *flow, uint32_t index, const uint8_t *ending, bool at_once)
{
    unsigned opcode = flow_opcode(flow, index);
    if (opcode == PROGRAM_RETURN) {
        return true;
    }
    int64_t target = flow->label[flow_label(flow, index)];
    bool stays = opcode == PROGRAM_CALL && (target == FLOW_NONE || ending[target] == 0);
    if (stays || (at_once && flow_waits(opcode))) {
        return false;
    }
    uint32_t next[FLOW_NEXT_MAX];
    bool ends = false;
    for (unsigned left = next_of(flow, index, next); left > 0; left--) {
        ends = ends || ending[next[left - 1U]] != 0;
    }
    return ends;
}

/* Finds the labels from which some path leads to the end of a subroutine. */
static bool find_ends(const struct flow *flow, bool at_once, bool ends[FLOW_LABELS])
{
    uint8_t *ending = flow_new_set(flow);
    if (ending == NULL) {
        return false;
    }
    bool has_grown = true;
    while (has_grown) {
        has_grown = false;
        for (uint32_t i = flow->count; i-- > 0;) {
            has_grown = (ending[i] == 0 && may_end(flow, i, ending, at_once) && add(ending, i)) || has_grown;
        }
    }
    for (unsigned label = 0; label < FLOW_LABELS; label++) {
        ends[label] = flow->label[label] != FLOW_NONE && ending[flow->label[label]] != 0;
    }
    free(ending);
    return true;
}

/* All that is reached from a command by flow_next; null if there is not memory enough. */
static uint8_t *reach(const struct flow *flow, uint32_t start)
{
    uint8_t *set = flow_new_set(flow);
    if (set != NULL && flow->count > 0) {
        set[start] = 1;
        while (grow(flow, set, flow_next)) {
        }
    }
    return set;
}

/* Finds the subroutines that are called in a flow and were not known; false without memory. */
static bool find_called(struct flow *flow, const uint8_t *set, bool *is_done)
{
    for (uint32_t i = 0; i < flow->count; i++) {
        unsigned label = set[i] != 0 && flow_opcode(flow, i) == PROGRAM_CALL ? flow_label(flow, i) : 0;
        if (flow->label[label] != FLOW_NONE && flow->subroutine[label] == NULL) {
            flow->subroutine[label] = reach(flow, (uint32_t)flow->label[label]);
            *is_done = false;
            if (flow->subroutine[label] == NULL) {
                return false;
            }
        }
    }
    return true;
}

static bool find_subroutines(struct flow *flow)
{
    bool is_done = true;
    bool good = find_called(flow, flow->main, &is_done);
    while (good && !is_done) {
        is_done = true;
        for (unsigned label = 0; label < FLOW_LABELS && good; label++) {
            good = flow->subroutine[label] == NULL || find_called(flow, flow->subroutine[label], &is_done);
        }
    }
    return good;
}

static void join(const struct flow *flow, const uint8_t *set)
{
    for (uint32_t i = 0; set != NULL && i < flow->count; i++) {
        flow->run[i] |= set[i];
    }
}

bool flow_read(struct flow *flow, const struct listing *listing)
{
    *flow = (struct flow){.commands = listing->commands + listing->start, .count = listing->count - listing->start};
    find_places(flow);
    if (!find_ends(flow, false, flow->ends) || !find_ends(flow, true, flow->ends_at_once)) {
        return false;
    }
    flow->main = reach(flow, 0);
    flow->run = flow_new_set(flow);
    if (flow->main == NULL || flow->run == NULL || !find_subroutines(flow)) {
        return false;
    }
    join(flow, flow->main);
    for (unsigned label = 0; label < FLOW_LABELS; label++) {
        join(flow, flow->subroutine[label]);
    }
    return true;
}

void flow_discard(struct flow *flow)
{
    free(flow->main);
    free(flow->run);
    for (unsigned label = 0; label < FLOW_LABELS; label++) {
        free(flow->subroutine[label]);
    }
    *flow = (struct flow){.count = 0};
}
