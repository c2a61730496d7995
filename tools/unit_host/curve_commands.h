/*
 * Which command of its program a motor runs, over a part of the time: the ordinals of commands, as message 7 counts
 * them, each with the time at which it began. The first ones of the part, as many as there is room for.
 */
#ifndef CURVE_COMMANDS_H
#define CURVE_COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "outfile.h"

struct curve_command {
    uint64_t tick;
    int64_t ordinal;
};

struct curve_commands {
    struct curve_command *list;
    uint32_t room;
    uint32_t count;
    int64_t before;    /* that at the beginning of the part; 0: none has begun */
    uint64_t cut_tick; /* from which the rest is left out; TICK_NEVER: all are there */
};

/* False if there is no memory; in both cases to be discarded. */
bool curve_commands_begin(struct curve_commands *commands, uint32_t room);

/* A command has begun; in order of time. The part of the time is from `from_tick` to `to_tick`, both included. */
void curve_commands_put(struct curve_commands *commands, const struct curve_command *command, uint64_t from_tick,
                        uint64_t to_tick);

/* Writes ,"command":before,"commands":[[time,ordinal],...],"commands_cut":time or null */
void curve_commands_write(const struct curve_commands *commands, struct outfile *file);

void curve_commands_discard(struct curve_commands *commands);

#endif
