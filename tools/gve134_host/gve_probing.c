#include "gve_probing.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gve_command.h"
#include "line.h"

enum {
    INTCOM = 0x10,
    RUN = 0x40,
    INTA = 0x80,
    ANSWER_ROOM = 128,
};

static enum gve_probing_result ask(struct gve_probing *probing, enum gve_probing_phase phase, const char *text)
{
    probing->phase = phase;
    (void)snprintf(probing->text, sizeof probing->text, "%s", text);
    return GVE_PROBING_SENDS;
}

static enum gve_probing_result end(struct gve_probing *probing, enum gve_probing_result result)
{
    probing->phase = GVE_PROBING_NONE;
    return result;
}

static enum gve_probing_result fail(struct gve_probing *probing, const char *reason)
{
    probing->reason = reason;
    return end(probing, GVE_PROBING_FAILS);
}

void gve_probing_approach(struct gve_probing *probing, const uint8_t *line, uint32_t length)
{
    struct gve_reading reading = gve_command_read(line, length, GVE_ADDRESS_INTERPOLATOR);
    for (unsigned axis = 0; axis < (unsigned)GVE_PROBING_AXES; axis++) {
        probing->moves[axis] = reading.command.numbers[axis] != 0;
    }
    (void)ask(probing, GVE_PROBING_RESTS, "F");
}

void gve_probing_begin(struct gve_probing *probing)
{
    (void)ask(probing, GVE_PROBING_MOVES, "F");
}

/* The answer to F, of axes that stand. */
static enum gve_probing_result take_state(struct gve_probing *probing, uint32_t state)
{
    bool inta = (state & INTA) != 0;
    if (probing->phase == GVE_PROBING_RESTS) {
        return ask(probing, GVE_PROBING_BEGINS, "P4");
    }
    if (probing->phase == GVE_PROBING_STANDS) {
        return inta ? fail(probing, "back") : end(probing, GVE_PROBING_DONE);
    }
    if ((state & INTCOM) != 0) {
        return fail(probing, "halted");
    }
    return inta ? ask(probing, GVE_PROBING_CAUSE, "SR4") : fail(probing, "untouched");
}

static enum gve_probing_result take_cause(struct gve_probing *probing, uint32_t causes)
{
    return causes != 0 ? fail(probing, "switch") : ask(probing, GVE_PROBING_LATCHED, "PL");
}

static bool read_positions(int64_t positions[GVE_PROBING_AXES], const char *answer, uint32_t length)
{
    char text[ANSWER_ROOM];
    (void)snprintf(text, sizeof text, "%.*s", (int)length, answer);
    char *at = text + strcspn(text, ",");
    for (unsigned axis = 0; axis < (unsigned)GVE_PROBING_AXES; axis++) {
        if (*at != ',') {
            return false;
        }
        positions[axis] = strtoll(at + 1, &at, 10);
    }
    return *at == '\0';
}

static enum gve_probing_result go_back(struct gve_probing *probing)
{
    probing->phase = GVE_PROBING_BACK;
    int64_t way[GVE_PROBING_AXES];
    for (unsigned axis = 0; axis < (unsigned)GVE_PROBING_AXES; axis++) {
        way[axis] = probing->moves[axis] ? probing->latched[axis] - probing->here[axis] : 0;
    }
    (void)snprintf(probing->text, sizeof probing->text, "L%" PRId64 ",%" PRId64 ",%" PRId64 ",%" PRId64, way[0], way[1],
                   way[2], way[3]);
    return GVE_PROBING_SENDS;
}

static enum gve_probing_result take_here(struct gve_probing *probing)
{
    bool moved = memcmp(probing->latched, probing->begin, sizeof probing->begin) != 0;
    return moved ? ask(probing, GVE_PROBING_OFF, "SW1,00") : fail(probing, "before");
}

static enum gve_probing_result take_status(struct gve_probing *probing, const char *answer, uint32_t length)
{
    uint32_t status = 0;
    if (length <= 2 || !line_read_hex(&answer[2], &answer[length], &status)) {
        return fail(probing, NULL);
    }
    if (probing->phase == GVE_PROBING_CAUSE) {
        return take_cause(probing, status);
    }
    return (status & (RUN | INTA)) == RUN ? GVE_PROBING_ASKS : take_state(probing, status);
}

static enum gve_probing_result take_positions(struct gve_probing *probing, const char *answer, uint32_t length)
{
    int64_t positions[GVE_PROBING_AXES];
    if (!read_positions(positions, answer, length)) {
        return fail(probing, NULL);
    }
    if (probing->phase == GVE_PROBING_BEGINS) {
        memcpy(probing->begin, positions, sizeof positions);
        return end(probing, GVE_PROBING_READY);
    }
    if (probing->phase == GVE_PROBING_LATCHED) {
        memcpy(probing->latched, positions, sizeof positions);
        return ask(probing, GVE_PROBING_HERE, "P4");
    }
    memcpy(probing->here, positions, sizeof positions);
    return take_here(probing);
}

enum gve_probing_result gve_probing_take(struct gve_probing *probing, const char *answer, uint32_t length)
{
    switch (probing->phase) {
    case GVE_PROBING_RESTS:
    case GVE_PROBING_MOVES:
    case GVE_PROBING_CAUSE:
    case GVE_PROBING_STANDS:
        return take_status(probing, answer, length);
    case GVE_PROBING_BEGINS:
    case GVE_PROBING_LATCHED:
    case GVE_PROBING_HERE:
        return take_positions(probing, answer, length);
    case GVE_PROBING_OFF:
        return ask(probing, GVE_PROBING_DROPS, "D");
    case GVE_PROBING_DROPS:
        return go_back(probing);
    case GVE_PROBING_BACK:
        return ask(probing, GVE_PROBING_STANDS, "F");
    case GVE_PROBING_NONE:
    default:
        return fail(probing, NULL);
    }
}
