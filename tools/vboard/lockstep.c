#include "lockstep.h"

#include <stdio.h>
#include <string.h>

#include "line.h"

enum {
    PS_DECIMALS = 9, /* of milliseconds */
    NS_DECIMALS = 6,
    BYTE_DIGITS = 2,
};

#define MS_MAX UINT64_C(1000000000)

static void reply(struct lockstep *lockstep)
{
    char text[LINE_NUMBER_BYTES_MAX];
    char *end = line_put_fixed(text, clock_now_ps(lockstep->clock) / VTIME_PS_PER_NS, NS_DECIMALS);
    (void)printf("%.*s ", (int)(end - text), text);
    for (unsigned i = 0; i < lockstep->heard; i++) {
        (void)printf("%02X", (unsigned)lockstep->byte[i]);
    }
    (void)putchar('\n');
    (void)fflush(stdout);
    lockstep->heard = 0;
    lockstep->asked = false;
}

static bool say(struct lockstep *lockstep, const char *at, const char *end)
{
    for (; end - at >= BYTE_DIGITS; at += BYTE_DIGITS) {
        uint32_t value = 0;
        if (!line_read_hex(at, at + BYTE_DIGITS, &value)) {
            return false;
        }
        rs485_say(lockstep->line, (uint8_t)value);
    }
    return at == end;
}

static bool go_on(struct lockstep *lockstep, const char *at, const char *end)
{
    uint64_t ps = 0;
    if (!line_read_fixed(&at, end, PS_DECIMALS, MS_MAX * VTIME_PS_PER_MS, &ps) || at != end) {
        return false;
    }
    lockstep->asked = true;
    clock_set_ps(lockstep->clock, EVENT_THROTTLE, ps);
    return true;
}

static bool connect_wire(struct lockstep *lockstep, char *at, char *end)
{
    struct wire wire;
    *end = '\0';
    return wires_read(at, &wire) && wires_connect(lockstep->wires, &wire);
}

static bool obey(struct lockstep *lockstep, char *at, char *end)
{
    static const char wire_word[] = "wire ";
    static const char say_word[] = "say ";
    static const char until_word[] = "until ";
    if (strncmp(at, say_word, sizeof say_word - 1U) == 0) {
        return say(lockstep, at + sizeof say_word - 1U, end);
    }
    if (strncmp(at, wire_word, sizeof wire_word - 1U) == 0) {
        return connect_wire(lockstep, at + sizeof wire_word - 1U, end);
    }
    return strncmp(at, until_word, sizeof until_word - 1U) == 0 && go_on(lockstep, at + sizeof until_word - 1U, end);
}

/* The next order; false: there are no more, or it makes no sense. */
static bool take_order(struct lockstep *lockstep)
{
    if (fgets(lockstep->order, sizeof lockstep->order, stdin) == NULL || strcmp(lockstep->order, "end\n") == 0) {
        report_finish(lockstep->report, REPORT_TIME, "");
        return false;
    }
    char *end = strchr(lockstep->order, '\n');
    if (end == NULL || !obey(lockstep, lockstep->order, end)) {
        report_finish(lockstep->report, REPORT_FAILED,
                      "--lockstep: an order is not `say HEXBYTES`, `until MS`, `wire PIN=PIN` or `end`");
        return false;
    }
    return true;
}

static void on_lockstep_event(void *model, uint64_t cycle)
{
    struct lockstep *lockstep = model;
    (void)cycle;
    if (lockstep->asked) {
        reply(lockstep);
    }
    while (!lockstep->asked && take_order(lockstep)) {
    }
}

void lockstep_hear(void *model, uint8_t value)
{
    struct lockstep *lockstep = model;
    if (lockstep->heard < LOCKSTEP_HEARD_MAX) {
        lockstep->byte[lockstep->heard++] = value;
    }
    clock_set_ps(lockstep->clock, EVENT_THROTTLE, clock_now_ps(lockstep->clock));
}

void lockstep_init(struct lockstep *lockstep, struct clock *clock, struct rs485 *line, struct wires *wires,
                   struct report *report)
{
    *lockstep = (struct lockstep){.clock = clock, .line = line, .wires = wires, .report = report};
}

void lockstep_open(struct lockstep *lockstep)
{
    clock_attach(lockstep->clock, EVENT_THROTTLE, on_lockstep_event, lockstep);
    clock_set_ps(lockstep->clock, EVENT_THROTTLE, 0);
}
