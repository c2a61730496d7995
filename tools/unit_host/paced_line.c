#include "paced_line.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "host_machine.h"
#include "paced_clock.h"
#include "units.h"

struct paced_line {
    struct host_machine machine;
    const struct unit_kind *kind;
    void *unit;
    struct paced_clock clock;
    uint32_t byte_ticks;
    struct host_line_byte heard[PACED_LINE_BYTES_MAX];
    uint32_t heard_count;
    uint8_t bytes[PACED_LINE_BYTES_MAX];
    uint8_t said[PACED_LINE_BYTES_MAX];
    uint32_t said_count;
};

static void hear_line(void *context, uint64_t tick, uint8_t value)
{
    struct paced_line *paced = context;
    (void)tick;
    if (paced->said_count < (uint32_t)PACED_LINE_BYTES_MAX) {
        paced->said[paced->said_count++] = value;
    }
}

struct paced_line *paced_line_begin(const struct unit_kind *kind, uint32_t byte_ticks, uint64_t real_ns)
{
    struct paced_line *paced = calloc(1, sizeof *paced);
    void *unit = calloc(1, kind->bytes);
    if (paced == NULL || unit == NULL) {
        free(paced);
        free(unit);
        return NULL;
    }
    paced->kind = kind;
    paced->unit = unit;
    paced->byte_ticks = byte_ticks;
    paced_clock_begin(&paced->clock, real_ns);
    host_machine_init(&paced->machine, 0);
    host_machine_select(&paced->machine);
    paced->machine.listener = (struct host_listener){.context = paced, .line = hear_line};
    kind->begin(unit);
    host_machine_set_byte_ticks(&paced->machine, byte_ticks);
    return paced;
}

bool paced_line_follow(struct paced_line *paced, uint64_t real_ns)
{
    return paced_clock_follow(&paced->clock, &paced->machine, real_ns, paced->kind->poll, paced->unit);
}

uint8_t *paced_line_bytes(struct paced_line *paced)
{
    return paced->bytes;
}

/* Forgets what the unit has heard. */
static void drop_heard(struct paced_line *paced)
{
    uint32_t done = paced->machine.line.script_next;
    paced->heard_count -= done;
    memmove(paced->heard, paced->heard + done, paced->heard_count * sizeof paced->heard[0]);
}

void paced_line_hear(struct paced_line *paced, uint32_t count)
{
    drop_heard(paced);
    uint64_t tick = paced->machine.now;
    if (paced->heard_count > 0 && paced->heard[paced->heard_count - 1U].tick > tick) {
        tick = paced->heard[paced->heard_count - 1U].tick;
    }
    for (uint32_t i = 0; i < count && paced->heard_count < (uint32_t)PACED_LINE_BYTES_MAX; i++) {
        tick += paced->byte_ticks;
        paced->heard[paced->heard_count++] = (struct host_line_byte){.tick = tick, .value = paced->bytes[i]};
    }
    host_machine_set_line(&paced->machine, paced->heard, paced->heard_count);
}

const uint8_t *paced_line_said(const struct paced_line *paced)
{
    return paced->said;
}

uint32_t paced_line_take_said(struct paced_line *paced)
{
    uint32_t count = paced->said_count;
    paced->said_count = 0;
    return count;
}

void paced_line_set_input(struct paced_line *paced, uint32_t input, bool level)
{
    bool turned = ((unsigned)paced->kind->inputs_turned >> (input - 1U) & 1U) != 0;
    host_machine_set_input(&paced->machine, input, level != turned);
}

uint64_t paced_line_stood_ns(const struct paced_line *paced)
{
    return units_ns_of_ticks(paced->clock.stood_ticks);
}
