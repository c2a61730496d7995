#include "wires.h"

#include <string.h>

#include "line.h"
#include "pins.h"

enum {
    NAME_BYTES_MAX = 8,
    NUMBER_MAX = 1000000000
};

static bool same(struct pin one, struct pin other)
{
    return one.port == other.port && one.number == other.number;
}

/* A pin's name that ends with one of some bytes; then `text` is there. */
static bool read_pin(const char **text, const char *ends, struct pin *pin)
{
    char name[NAME_BYTES_MAX] = "";
    size_t length = strcspn(*text, ends);
    if (length >= sizeof name) {
        return false;
    }
    memcpy(name, *text, length);
    *text += length;
    return pins_read_name(name, pin);
}

static bool read_number(const char *text, const char *name, uint32_t *number)
{
    const char *end = text + strlen(text);
    uint64_t value = 0;
    if (strncmp(text, name, strlen(name)) != 0) {
        return false;
    }
    text += strlen(name);
    bool good = line_read_fixed(&text, end, 0, NUMBER_MAX, &value) && text == end && value > 0;
    *number = (uint32_t)value;
    return good;
}

bool wires_read(const char *text, struct wire *wire)
{
    static const char none[] = "none=";
    *wire = (struct wire){.from = {.port = GPIO_PORTS}, .due_ps = VTIME_NEVER};
    if (strncmp(text, none, sizeof none - 1U) == 0) {
        text += sizeof none - 1U;
        return read_pin(&text, "", &wire->to);
    }
    if (!read_pin(&text, "=", &wire->from) || *text != '=') {
        return false;
    }
    text++;
    if (!read_pin(&text, ":", &wire->to)) {
        return false;
    }
    return *text == '\0' || read_number(text, ":late=", &wire->late_ns) || read_number(text, ":loses=", &wire->loses);
}

static void plan(struct wires *wires)
{
    uint64_t next = VTIME_NEVER;
    for (unsigned i = 0; i < wires->count; i++) {
        next = wires->wire[i].due_ps < next ? wires->wire[i].due_ps : next;
    }
    if (next == VTIME_NEVER) {
        clock_set(wires->clock, EVENT_WIRES, VTIME_NEVER);
    } else {
        clock_set_ps(wires->clock, EVENT_WIRES, next);
    }
}

static void on_wires_event(void *model, uint64_t cycle)
{
    struct wires *wires = model;
    uint64_t now_ps = clock_ps_of_cycle(wires->clock, cycle);
    for (unsigned i = 0; i < wires->count; i++) {
        struct wire *wire = &wires->wire[i];
        if (wire->due_ps <= now_ps) {
            wire->due_ps = VTIME_NEVER;
            gpio_set_outside(wires->gpio, wire->to, true, cycle);
        }
    }
    plan(wires);
}

static void bring_up(struct wires *wires, struct wire *wire, uint64_t cycle)
{
    wire->rises++;
    if (wire->loses != 0 && wire->rises % wire->loses == 0) {
        return;
    }
    if (wire->late_ns == 0) {
        gpio_set_outside(wires->gpio, wire->to, true, cycle);
        return;
    }
    wire->due_ps = clock_ps_of_cycle(wires->clock, cycle) + wire->late_ns * VTIME_PS_PER_NS;
    plan(wires);
}

void wires_note_edge(struct wires *wires, struct pin pin, bool level, uint64_t cycle)
{
    for (unsigned i = 0; i < wires->count; i++) {
        struct wire *wire = &wires->wire[i];
        if (!same(wire->from, pin)) {
            continue;
        }
        if (level) {
            bring_up(wires, wire, cycle);
        } else {
            wire->due_ps = VTIME_NEVER;
            plan(wires);
            gpio_set_outside(wires->gpio, wire->to, false, cycle);
        }
    }
}

static struct wire *find_place(struct wires *wires, struct pin to)
{
    for (unsigned i = 0; i < wires->count; i++) {
        if (same(wires->wire[i].to, to)) {
            return &wires->wire[i];
        }
    }
    return wires->count < WIRES_MAX ? &wires->wire[wires->count++] : NULL;
}

bool wires_connect(struct wires *wires, const struct wire *wire)
{
    struct wire *place = find_place(wires, wire->to);
    uint64_t now = wires->clock->now;
    if (place == NULL) {
        return false;
    }
    *place = *wire;
    plan(wires);
    if (wire->from.port == GPIO_PORTS) {
        gpio_let_go(wires->gpio, wire->to, now);
    } else {
        gpio_set_outside(wires->gpio, wire->to, gpio_level(wires->gpio, wire->from), now);
    }
    return true;
}

void wires_init(struct wires *wires, struct clock *clock, struct gpio *gpio)
{
    *wires = (struct wires){.clock = clock, .gpio = gpio};
    clock_attach(clock, EVENT_WIRES, on_wires_event, wires);
}
