/*
 * The summary of a simulation, as one JSON object on standard output.
 */
#ifndef SUMMARY_H
#define SUMMARY_H

#include "feed.h"
#include "run.h"

void summary_print(const struct run *run, const struct rkm04 *unit, const struct feed *feed);

/* The name of an enum interpreter_state. */
const char *summary_state_text(unsigned state);
enum {
    SUMMARY_STATES = INTERPRETER_FAILED + 1
};

#endif
