/*
 * The options of `rkm04-host sim`, from the command line.
 */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "base_limits.h"
#include "complain.h"
#include "sim_options.h"

struct options {
    struct sim_options sim;
    const char *programs[UNIT_MOTORS]; /* the file of each motor; null: none */
};

/* The usage of the whole program. */
extern const char options_usage[];

/* Reads what follows `sim`. EXIT_DONE, or EXIT_USAGE after a complaint. */
enum exit_status options_read(struct options *options, int count, char *const arguments[]);

#endif
