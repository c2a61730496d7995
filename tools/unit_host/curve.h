/*
 * The curve file: speed and position of every motor over time, thinned (thin.h) so that it can be drawn at once however
 * long the simulation was. One JSON object:
 *
 * {"motors":[{"motor":1,"t":[0.000000,...],"speed":[0.000,...],"position":[0,...],
 *             "before":0,"steps":[[0.010000,1],...],
 *             "command":0,"commands":[[0.000000,1],...],"commands_cut":null},...],
 *  "outputs":[[0.500000,2,1],...],"outputs_cut":null}
 * Times in seconds, speeds in steps/s with the sign of the direction: the mean of each interval between two pulses in
 * its middle, and 0 outside moves. Steps: time and new position of every single pulse, and of every position that was
 * written, in the part of the time, which begins at the position `before`; null if there are more than a line has
 * points.
 * Commands: time at which it began and ordinal of every command that was run in the part, from 1 as message 7 counts
 * them; before the first of them it was `command`, 0 where none had begun. After as many as a line has points the rest
 * is left out, and commands_cut is the time from which. Units without programs have none.
 * Outputs: time, number, level of each change; after as many as a line has points
 * the rest is left out, and outputs_cut is the time from which.
 */
#ifndef CURVE_H
#define CURVE_H

#include <stdbool.h>
#include <stdint.h>

#include "base_limits.h"
#include "curve_commands.h"
#include "outfile.h"
#include "thin.h"
#include "timeline.h"

enum {
    CURVE_POINTS_MIN = 24,
    CURVE_POINTS_MAX = 200000,
    CURVE_POINTS_DEFAULT = 2000,
};

struct curve_range {
    uint32_t points;    /* of a motor, at most; two more lead in and out of the part */
    uint64_t from_tick; /* the part of the time that is wanted */
    uint64_t to_tick;
};

/* A change of the position: a pulse, or a position that was written. */
struct curve_step {
    uint64_t tick;
    int64_t position;
};

struct curve_motor {
    struct thin thin;
    struct curve_step *steps;       /* of the part */
    struct curve_commands commands; /* of the part */
    uint32_t steps_count;           /* one more than there is room for: too many, and none is told */
    int64_t steps_before;           /* the position at the beginning of the part */
    struct thin_point before;       /* the last point before the part */
    bool has_before;
    bool is_over; /* a point after the part has been taken */
    bool moving;
    bool fresh;    /* a move has begun and made no step yet */
    uint64_t tick; /* of the last point; of events that come too late as well */
    uint64_t move_tick;
    int64_t milli_speed; /* of the last interval */
    uint64_t interval_ticks;
    int64_t interval_speed; /* of interval_ticks, which is 0 at first, as this */
    int64_t position;
};

struct curve_output {
    uint64_t tick;
    uint8_t number;
    uint8_t level;
};

struct curve {
    struct outfile *file;
    struct curve_range range;
    struct curve_motor motors[UNIT_MOTORS];
    struct curve_output *outputs;
    uint32_t outputs_count;
    uint64_t cut_tick; /* TICK_NEVER: all outputs are there */
    uint8_t levels;
};

/* Every motor stands at 0. False after a complaint; in both cases to be discarded. */
bool curve_begin(struct curve *curve, struct outfile *file, const struct curve_range *range);

/* Takes an event; those of a motor come in order of time, and so do those of outputs. */
void curve_put(struct curve *curve, const struct timeline_event *event);

/* A command of a motor, from 0, has begun at `tick`; in order of time. */
void curve_put_command(struct curve *curve, unsigned motor, uint64_t tick, int64_t ordinal);

/* Writes the file. */
void curve_end(struct curve *curve, uint64_t end_tick);

void curve_discard(struct curve *curve);

#endif
