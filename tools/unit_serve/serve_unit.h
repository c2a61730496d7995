/*
 * One of the units of `serve`: the firmware on a machine of its own, with its flash in a file. Large (320 kB): on the
 * heap.
 */
#ifndef SERVE_UNIT_H
#define SERVE_UNIT_H

#include <stdbool.h>
#include <stdint.h>

#include "complain.h"
#include "host_machine.h"
#include "serve_flash.h"
#include "serve_kind.h"
#include "serve_line.h"

enum {
    SERVE_STATUS_BYTES_MAX = 768
};

struct serve_unit {
    struct host_machine machine;
    const struct serve_kind *kind;
    void *unit;
    struct serve_flash flash;
    uint32_t saved_operations; /* flash operations that the file has, or that it could not be given */
    bool unsaved;              /* the last writing has failed */
    struct serve_line *line;
    int64_t travel_steps[UNIT_MOTORS]; /* pulses forward less those backward, whatever the position counter says */
};

/* Room for a unit, to be discarded. Null: there is not memory enough. */
struct serve_unit *serve_unit_make(const struct serve_kind *kind);

/* A unit at time 0, with the flash of its file, if it has one. EXIT_DONE, or after a complaint what else. */
enum exit_status serve_unit_begin(struct serve_unit *unit, uint8_t node, const char *flash_path);

/* From now on the line hears what it sends. */
void serve_unit_attach(struct serve_unit *unit, struct serve_line *line);

/* Lets it run up to a tick. */
void serve_unit_run(struct serve_unit *unit, uint64_t until_tick);

/* Whether time alone brings more: something runs or is on the line. */
bool serve_unit_has_work(const struct serve_unit *unit);

/* Writes the file if the flash has changed. False after a complaint. */
bool serve_unit_save(struct serve_unit *unit);

/* Writes the file if it could not be written before. False after a complaint. */
bool serve_unit_save_rest(struct serve_unit *unit);

/* Writes the unit's state as one JSON object, without what encloses it; returns its end. */
char *serve_unit_put_status(const struct serve_unit *unit, char *at);

void serve_unit_discard(struct serve_unit *unit);

#endif
