/*
 * The line between clients and units: what clients send goes to every unit at the same tick, what units send to every
 * client, or to the one that has asked (serve_turns.h). Units do not hear each other. A bad line loses and changes
 * bytes on both ways; all who listen miss the same.
 */
#ifndef SERVE_LINE_H
#define SERVE_LINE_H

#include <stdbool.h>
#include <stdint.h>

#include "host_machine.h"
#include "serve_noise.h"
#include "serve_options.h"
#include "serve_port.h"
#include "serve_turns.h"

enum {
    SERVE_HEARD_MAX = 16384,                 /* bytes from clients that are not yet at the units */
    SERVE_ROOM_MIN = SERVE_HEARD_MAX - 4096, /* with less room more wait where they come from */
    SERVE_SAID_MAX = 16384,
};

struct serve_line {
    struct host_line_byte heard[SERVE_HEARD_MAX]; /* sorted by tick */
    uint32_t heard_count;
    uint32_t byte_ticks;          /* from one byte to the next */
    uint64_t last_tick;           /* of the last byte that was put on the line */
    uint8_t said[SERVE_SAID_MAX]; /* by units, not yet given to clients */
    uint32_t said_count;
    int said_to;               /* the client that is to have it; -1: none */
    struct serve_turns *turns; /* null: all clients have all */
    struct serve_port *port;
    struct serve_noise to_units;
    struct serve_noise to_clients;
};

/* `byte_ticks`: what a byte takes, unless the options say that it takes next to nothing; 0: not known yet. */
void serve_line_init(struct serve_line *line, struct serve_port *port, struct serve_turns *turns, uint32_t byte_ticks,
                     const struct serve_options *options);

/* Forgets the bytes that all units have heard: those before `now`. Returns the room for more. */
uint32_t serve_line_room(struct serve_line *line, uint64_t now);

/* Puts bytes of a client on the line, now or after what is there. There must be room; the machines are then to be
 * given `heard` as their script. */
void serve_line_put(struct serve_line *line, uint64_t now, const uint8_t *bytes, uint32_t count);

/* Takes a byte of a unit, which `resets` or does not. */
void serve_line_say(struct serve_line *line, uint8_t value, bool resets);

/* Gives clients what units have said. */
void serve_line_flush(struct serve_line *line);

#endif
