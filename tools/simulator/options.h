/*
 * The options of `rkm04-host sim`, from the command line.
 */
#ifndef OPTIONS_H
#define OPTIONS_H

#include <stdint.h>

#include "base_limits.h"
#include "complain.h"
#include "recorder.h"

/* Unit time of a simulation that does not end by itself, unless --for says more or less. */
#define OPTIONS_DURATION_NS UINT64_C(60000000000)

struct options {
    const char *programs[UNIT_MOTORS]; /* the file of each motor; null: none */
    const char *inputs;                /* null: none */
    struct recorder_paths paths;
    uint64_t duration_ns;
    uint64_t progress_ns; /* so often it tells how far it is; 0: never */
    uint64_t real_ns;     /* ends after so much real time too; 0: does not */
    uint64_t epoch;       /* the unit's time at the start, ticks */
};

/* The usage of the whole program. */
extern const char options_usage[];

/* Reads what follows `sim`. EXIT_DONE, or EXIT_USAGE after a complaint. */
enum exit_status options_read(struct options *options, int count, char *const arguments[]);

#endif
