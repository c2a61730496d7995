#include "gve_probing.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

void gve_probing_begin(struct gve_probing *probing)
{
    (void)ask(probing, GVE_PROBING_MOVES, "F");
}

static enum gve_probing_result take_state(struct gve_probing *probing, uint32_t state)
{
    bool waits = probing->phase == GVE_PROBING_MOVES ? (state & (RUN | INTA)) == RUN : (state & RUN) != 0;
    if (waits) {
        return GVE_PROBING_ASKS;
    }
    if (probing->phase == GVE_PROBING_STANDS) {
        return end(probing, GVE_PROBING_DONE);
    }
    if ((state & (INTA | INTCOM)) != INTA) {
        return end(probing, GVE_PROBING_UNTOUCHED);
    }
    return ask(probing, GVE_PROBING_OFF, "SW1,00");
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
        way[axis] = probing->latched[axis] - probing->here[axis];
    }
    (void)snprintf(probing->text, sizeof probing->text, "L%" PRId64 ",%" PRId64 ",%" PRId64 ",%" PRId64, way[0], way[1],
                   way[2], way[3]);
    return GVE_PROBING_SENDS;
}

static enum gve_probing_result wrong(struct gve_probing *probing)
{
    return end(probing, GVE_PROBING_WRONG);
}

enum gve_probing_result gve_probing_take(struct gve_probing *probing, const char *answer, uint32_t length)
{
    uint32_t state = 0;
    switch (probing->phase) {
    case GVE_PROBING_MOVES:
    case GVE_PROBING_STANDS:
        return length > 2 && line_read_hex(&answer[2], &answer[length], &state) ? take_state(probing, state)
                                                                                : wrong(probing);
    case GVE_PROBING_OFF:
        return ask(probing, GVE_PROBING_LATCHED, "PL");
    case GVE_PROBING_LATCHED:
        return read_positions(probing->latched, answer, length) ? ask(probing, GVE_PROBING_HERE, "P4") : wrong(probing);
    case GVE_PROBING_HERE:
        return read_positions(probing->here, answer, length) ? ask(probing, GVE_PROBING_DROPS, "D") : wrong(probing);
    case GVE_PROBING_DROPS:
        return go_back(probing);
    case GVE_PROBING_BACK:
        return ask(probing, GVE_PROBING_STANDS, "F");
    case GVE_PROBING_NONE:
    default:
        return wrong(probing);
    }
}
