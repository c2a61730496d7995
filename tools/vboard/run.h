/*
 * The loop around Unicorn: what happens between two stretches of emulation.
 */
#ifndef RUN_H
#define RUN_H

#include <stdbool.h>

#include "board.h"

/* Runs until the end that is in the report. False after a complaint: it cannot. */
bool run(struct board *board);

#endif
