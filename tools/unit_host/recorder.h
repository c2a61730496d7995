/*
 * The output files of a simulation: takes what happens, in nearly the order of time, and writes the files that were
 * asked for. Costs nothing where none was.
 */
#ifndef RECORDER_H
#define RECORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "curve.h"
#include "outfile.h"
#include "timeline.h"
#include "unit_kind.h"
#include "waves.h"

/* Where to; null: not wanted. */
struct recorder_paths {
    const char *steps;
    const char *trace;
    const char *vcd;
    const char *curve;
    struct curve_range range; /* of the curve */
};

struct recorder {
    const struct unit_kind *kind;
    struct timeline timeline;
    struct outfile steps;
    struct outfile trace;
    struct outfile waves;
    struct waves drawing;
    struct outfile line;
    struct curve curve;
    bool sorts;  /* there is a file of all that happens; a curve needs the order of each motor only */
    bool active; /* there is a file */
};

/* Opens the files. False after a complaint; nothing is left open then. */
bool recorder_open(struct recorder *recorder, const struct recorder_paths *paths, const struct unit_kind *kind);

/* Takes an event; `now_ticks` is the time at which it is told. A step brings its falling edge along. Only while
 * active. */
void recorder_put(struct recorder *recorder, const struct timeline_event *event, uint64_t now_ticks);

/* A command of the program of motor 1 to 4 has begun at `tick`. Only while active. */
void recorder_put_command(struct recorder *recorder, uint64_t tick, unsigned motor, int64_t ordinal);

/* Completes all files and gives them their names. False after a complaint; then none that is not whole gets one. */
bool recorder_finish(struct recorder *recorder, uint64_t end_tick);

/* Lets go of the files; those that are not finished vanish. */
void recorder_discard(struct recorder *recorder);

#endif
