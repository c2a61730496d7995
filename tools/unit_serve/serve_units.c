#include "serve_units.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base_tick.h"

enum {
    SUFFIX_BYTES = 16
};

/* A unit that does not complain is in the list. */
static enum exit_status add_unit(struct serve_units *units, uint8_t node, const char *flash_path)
{
    struct serve_unit *unit = serve_unit_make(units->kind);
    if (unit == NULL) {
        complain("there is not memory enough for a unit; close other programs");
        return EXIT_REFUSED;
    }
    units->list[units->count++] = unit;
    return serve_unit_begin(unit, node, flash_path);
}

static enum exit_status add_numbered_unit(struct serve_units *units, uint8_t node, const char *flash)
{
    size_t room = strlen(flash) + SUFFIX_BYTES;
    char *path = malloc(room);
    if (path == NULL) {
        complain("there is not memory enough for a unit; close other programs");
        return EXIT_REFUSED;
    }
    (void)snprintf(path, room, "%s.node%u", flash, (unsigned)node);
    enum exit_status status = add_unit(units, node, path);
    free(path);
    return status;
}

/* Bytes take what the kind says, or else what the unit has set; those of clients what the slowest unit needs. */
static void pace(struct serve_unit *unit, const struct serve_options *options, struct serve_line *line)
{
    if (options->unpaced || unit->kind->byte_ticks != 0) {
        host_machine_set_byte_ticks(&unit->machine, options->unpaced ? 0 : unit->kind->byte_ticks);
    }
    if (!options->unpaced && line->byte_ticks < unit->machine.line.byte_ticks) {
        line->byte_ticks = unit->machine.line.byte_ticks;
    }
}

enum exit_status serve_units_begin(struct serve_units *units, const struct serve_kind *kind,
                                   const struct serve_options *options, struct serve_line *line)
{
    units->kind = kind;
    enum exit_status status = EXIT_DONE;
    units->count = 0;
    units->now = 0;
    for (unsigned i = 0; i < options->units && status == EXIT_DONE; i++) {
        bool numbered = options->flash != NULL && options->units > 1;
        uint8_t node = options->nodes[i];
        status = numbered ? add_numbered_unit(units, node, options->flash) : add_unit(units, node, options->flash);
        if (status == EXIT_DONE) {
            serve_unit_attach(units->list[i], line);
            pace(units->list[i], options, line);
        }
    }
    return status;
}

void serve_units_run(struct serve_units *units, uint64_t until_tick)
{
    if (until_tick <= units->now) {
        return;
    }
    for (unsigned i = 0; i < units->count; i++) {
        serve_unit_run(units->list[i], until_tick);
    }
    units->now = until_tick;
}

uint64_t serve_units_next_tick(const struct serve_units *units)
{
    uint64_t next = TICK_NEVER;
    for (unsigned i = 0; i < units->count; i++) {
        uint64_t tick = host_machine_next_tick(&units->list[i]->machine);
        next = tick < next ? tick : next;
    }
    return next;
}

bool serve_units_have_work(const struct serve_units *units)
{
    for (unsigned i = 0; i < units->count; i++) {
        if (serve_unit_has_work(units->list[i])) {
            return true;
        }
    }
    return false;
}

bool serve_units_owe(const struct serve_units *units)
{
    for (unsigned i = 0; i < units->count; i++) {
        const struct serve_unit *unit = units->list[i];
        if (unit->machine.line.next_tick != TICK_NEVER || unit->kind->owes(unit->unit)) {
            return true;
        }
    }
    return false;
}

void serve_units_hear(struct serve_units *units, const struct serve_line *line)
{
    for (unsigned i = 0; i < units->count; i++) {
        host_machine_set_line(&units->list[i]->machine, line->heard, line->heard_count);
    }
}

const char *serve_units_set_input(struct serve_units *units, const struct serve_order *order)
{
    if (order->node == 0 && units->count > 1) {
        return "there are several units; name one before the input, as 2.3=1";
    }
    for (unsigned i = 0; i < units->count; i++) {
        struct host_machine *machine = &units->list[i]->machine;
        if (order->node == 0 || machine->line.node == order->node) {
            bool turned = ((unsigned)units->kind->unit->inputs_turned >> (order->input - 1U) & 1U) != 0;
            host_machine_set_input(machine, order->input, order->level != turned);
            return NULL;
        }
    }
    return "there is no such unit; ? lists them";
}

void serve_units_save(struct serve_units *units)
{
    for (unsigned i = 0; i < units->count; i++) {
        (void)serve_unit_save(units->list[i]);
    }
}

bool serve_units_save_rest(struct serve_units *units)
{
    bool good = true;
    for (unsigned i = 0; i < units->count; i++) {
        good = serve_unit_save_rest(units->list[i]) && good;
    }
    return good;
}

void serve_units_discard(struct serve_units *units)
{
    for (unsigned i = 0; i < units->count; i++) {
        serve_unit_discard(units->list[i]);
    }
    units->count = 0;
}
