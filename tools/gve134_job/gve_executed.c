#include "gve_executed.h"

#include <string.h>

#include "base_wide.h"
#include "gve_reply.h"

/* Commands that are still to be read. */
struct commands {
    const uint8_t *text;
    uint32_t length;
};

/* A part of a vector. */
struct part {
    uint32_t count;
    uint32_t whole;
};

/* Where axes are on a path of vectors. */
struct search {
    const int32_t *place;            /* of the axes */
    bool moved[GVE_EXECUTED_AXES];   /* those that count */
    uint32_t at[GVE_EXECUTED_AXES];  /* where the vector begins */
    int32_t ways[GVE_EXECUTED_AXES]; /* from there to the place */
    uint64_t gone;                   /* all of them */
};

/* The next one without a fault; false: there is none. */
static bool read_command(struct commands *left, struct gve_command *command)
{
    while (left->length > 0) {
        const uint8_t *end = memchr(left->text, '\n', left->length);
        uint32_t length = end != NULL ? (uint32_t)(end - left->text) : left->length;
        struct gve_reading reading = gve_reply_reading(left->text, length);
        uint32_t used = length + (end != NULL ? 1U : 0U);
        left->text += used;
        left->length -= used;
        if (reading.fault == GVE_FAULT_NONE) {
            *command = reading.command;
            return true;
        }
    }
    return false;
}

static bool read_vector(struct commands *left, struct gve_command *command)
{
    while (read_command(left, command)) {
        if (command->opcode == (uint8_t)GVE_LINE || command->opcode == (uint8_t)GVE_CONTINUE) {
            return true;
        }
    }
    return false;
}

static bool has_pulses(const int32_t steps[GVE_EXECUTED_AXES])
{
    return steps[0] != 0 || steps[1] != 0 || steps[2] != 0 || steps[3] != 0;
}

static uint32_t magnitude(int32_t number)
{
    return number < 0 ? 0U - (uint32_t)number : (uint32_t)number;
}

static void note_moved(bool moved[GVE_EXECUTED_AXES], const int32_t steps[GVE_EXECUTED_AXES])
{
    for (unsigned axis = 0; axis < (unsigned)GVE_EXECUTED_AXES; axis++) {
        moved[axis] = moved[axis] || steps[axis] != 0;
    }
}

static void advance(uint32_t at[GVE_EXECUTED_AXES], const int32_t steps[GVE_EXECUTED_AXES])
{
    for (unsigned axis = 0; axis < (unsigned)GVE_EXECUTED_AXES; axis++) {
        at[axis] += (uint32_t)steps[axis];
    }
}

/* ---- what was taken ---- */

static struct gve_executed_vector *waiting(struct gve_executed *executed, uint32_t number)
{
    return &executed->ring[(executed->first + number) % (uint32_t)GVE_EXECUTED_PLACES];
}

/* The first ones are over. */
static void pass(struct gve_executed *executed, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const struct gve_executed_vector *vector = waiting(executed, 0);
        advance(executed->place, vector->steps);
        executed->done += 1U + vector->empty;
        executed->first = (executed->first + 1U) % (uint32_t)GVE_EXECUTED_PLACES;
        executed->waiting--;
        executed->gone = 0;
    }
}

static void append(struct gve_executed *executed, const int32_t steps[GVE_EXECUTED_AXES])
{
    if (!has_pulses(steps)) {
        uint32_t *count = executed->waiting > 0 ? &waiting(executed, executed->waiting - 1U)->empty : &executed->done;
        *count += 1U;
        return;
    }
    if (executed->waiting == (uint32_t)GVE_EXECUTED_PLACES) {
        pass(executed, 1);
    }
    struct gve_executed_vector *vector = waiting(executed, executed->waiting);
    executed->waiting++;
    memcpy(vector->steps, steps, sizeof vector->steps);
    vector->empty = 0;
    note_moved(executed->moved, steps);
}

static void take_command(struct gve_executed *executed, const struct gve_command *command)
{
    switch (command->opcode) {
    case GVE_LINE:
        pass(executed, executed->waiting);
        append(executed, command->numbers);
        break;
    case GVE_CONTINUE:
        append(executed, command->numbers);
        break;
    case GVE_ZERO:
        pass(executed, executed->waiting);
        memset(executed->place, 0, sizeof executed->place);
        break;
    case GVE_SET_POSITION:
        pass(executed, executed->waiting);
        executed->place[command->numbers[0]] = (uint32_t)command->numbers[1];
        break;
    case GVE_REFERENCE:
    case GVE_DELETE:
    case GVE_KEEP:
    case GVE_RESTORE:
    case GVE_RESET:
        executed->unknown = true;
        break;
    default:
        break;
    }
}

/* ---- where the axes are ---- */

static bool is_before(struct part a, struct part b)
{
    return (uint64_t)a.count * b.whole < (uint64_t)b.count * a.whole;
}

/* Whether the axes come by a place on a vector, given from where that begins: each makes its pulse k when the path has
 * come to the part k / |steps| of the vector. */
static bool is_on(const int32_t steps[GVE_EXECUTED_AXES], const int32_t ways[GVE_EXECUTED_AXES])
{
    struct part begin = {.count = 0, .whole = 1};
    struct part end = {.count = 2, .whole = 1};
    for (unsigned axis = 0; axis < (unsigned)GVE_EXECUTED_AXES; axis++) {
        const struct part came = {.count = magnitude(ways[axis]), .whole = magnitude(steps[axis])};
        if (came.count > came.whole || (came.count > 0 && (steps[axis] < 0) != (ways[axis] < 0))) {
            return false;
        }
        if (came.whole > 0) {
            const struct part next = {.count = came.count + 1U, .whole = came.whole};
            begin = is_before(begin, came) ? came : begin;
            end = is_before(next, end) ? next : end;
        }
    }
    return is_before(begin, end);
}

/* Whether the place is on the next vector of the path; else it may be on the one after it. */
static bool finds(struct search *search, const int32_t steps[GVE_EXECUTED_AXES], uint64_t gone_least)
{
    search->gone = 0;
    for (unsigned axis = 0; axis < (unsigned)GVE_EXECUTED_AXES; axis++) {
        uint32_t way = search->moved[axis] ? (uint32_t)search->place[axis] - search->at[axis] : 0U;
        search->ways[axis] = wide_to_signed_32(way);
        search->gone += magnitude(search->ways[axis]);
    }
    if (is_on(steps, search->ways) && search->gone >= gone_least) {
        return true;
    }
    advance(search->at, steps);
    return false;
}

/* 1: the vector on which the place was found is over there. */
static uint32_t ends(const struct search *search, const int32_t steps[GVE_EXECUTED_AXES])
{
    return memcmp(search->ways, steps, sizeof search->ways) == 0 ? 1U : 0U;
}

/* The same on what was perhaps taken. Axes at the end of what was taken tell nothing of that. */
static uint32_t look_ahead(struct gve_executed *executed, struct search *search, const struct commands *perhaps)
{
    static const int32_t none[GVE_EXECUTED_AXES] = {0};
    uint32_t ahead = 0;
    if (finds(search, none, 0)) {
        return executed->done;
    }
    struct gve_command command;
    for (struct commands left = *perhaps; read_vector(&left, &command);) {
        note_moved(search->moved, command.numbers);
    }
    for (struct commands left = *perhaps; read_vector(&left, &command); ahead++) {
        if (finds(search, command.numbers, 0)) {
            pass(executed, executed->waiting);
            return executed->done + ahead + ends(search, command.numbers);
        }
    }
    return executed->done;
}

/* How many are over, by where the axes are. */
static uint32_t look(struct gve_executed *executed, struct search *search, const struct commands *perhaps)
{
    for (uint32_t i = 0; i < executed->waiting; i++) {
        const int32_t *steps = waiting(executed, i)->steps;
        if (finds(search, steps, i == 0 ? executed->gone : 0)) {
            uint32_t over = i + ends(search, steps);
            pass(executed, over);
            executed->gone = over == i ? search->gone : 0;
            return executed->done;
        }
    }
    return look_ahead(executed, search, perhaps);
}

/* ---- from outside ---- */

void gve_executed_init(struct gve_executed *executed, const int32_t place[GVE_EXECUTED_AXES])
{
    memset(executed, 0, sizeof *executed);
    gve_executed_stand(executed, place);
}

void gve_executed_lose(struct gve_executed *executed)
{
    executed->unknown = true;
}

void gve_executed_take(struct gve_executed *executed, const uint8_t *text, uint32_t length)
{
    struct commands left = {.text = text, .length = length};
    struct gve_command command;
    while (read_command(&left, &command)) {
        take_command(executed, &command);
    }
}

void gve_executed_stand(struct gve_executed *executed, const int32_t place[GVE_EXECUTED_AXES])
{
    pass(executed, executed->waiting);
    memcpy(executed->place, place, sizeof executed->place);
}

uint32_t gve_executed_look(struct gve_executed *executed, const int32_t place[GVE_EXECUTED_AXES], const uint8_t *text,
                           uint32_t length)
{
    const struct commands perhaps = {.text = text, .length = length};
    struct search search = {.place = place};
    memcpy(search.at, executed->place, sizeof search.at);
    memcpy(search.moved, executed->moved, sizeof search.moved);
    uint32_t over = look(executed, &search, &perhaps);
    return executed->unknown ? GVE_EXECUTED_UNKNOWN : over;
}

uint32_t gve_executed_done(const struct gve_executed *executed)
{
    return executed->unknown ? GVE_EXECUTED_UNKNOWN : executed->done;
}
