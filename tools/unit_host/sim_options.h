/*
 * The options that `sim` of all units has. Those of a unit begin with them, and its table with their rows.
 */
#ifndef SIM_OPTIONS_H
#define SIM_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "arguments.h"
#include "recorder.h"

/* Unit time of a simulation that does not end by itself, unless --for says more or less. */
#define SIM_OPTIONS_DURATION_NS UINT64_C(60000000000)

struct sim_options {
    const char *inputs; /* null: none */
    struct recorder_paths paths;
    uint64_t duration_ns;
    uint64_t progress_ns; /* so often it tells how far it is; 0: never */
    uint64_t real_ns;     /* ends after so much real time too; 0: does not */
    uint64_t epoch;       /* the unit's time at the start, ticks */
};

/* As they are without a command line. */
struct sim_options sim_options_init(void);

/* Whether they go together. False after a complaint. */
bool sim_options_are_whole(const struct sim_options *options);

argument_reader sim_options_read_duration, sim_options_read_real, sim_options_read_progress, sim_options_read_epoch,
    sim_options_read_points, sim_options_read_from, sim_options_read_to;

#define SIM_OPTIONS_ROWS                                                                                               \
    ARGUMENT_TEXT_ROW(sim_options, "--inputs", inputs), ARGUMENT_TEXT_ROW(sim_options, "--steps", paths.steps),        \
        ARGUMENT_TEXT_ROW(sim_options, "--trace", paths.trace), ARGUMENT_TEXT_ROW(sim_options, "--vcd", paths.vcd),    \
        ARGUMENT_TEXT_ROW(sim_options, "--curve", paths.curve),                                                        \
        ARGUMENT_OTHER_ROW("--for", sim_options_read_duration), ARGUMENT_OTHER_ROW("--real", sim_options_read_real),   \
        ARGUMENT_OTHER_ROW("--progress", sim_options_read_progress),                                                   \
        ARGUMENT_OTHER_ROW("--epoch", sim_options_read_epoch),                                                         \
        ARGUMENT_OTHER_ROW("--points", sim_options_read_points), ARGUMENT_OTHER_ROW("--from", sim_options_read_from),  \
        ARGUMENT_OTHER_ROW("--to", sim_options_read_to)

#endif
