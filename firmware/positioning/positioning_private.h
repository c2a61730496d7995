/*
 * What the files of the unit share: positioning.c (start, interrupts, pass), positioning_plc.c (instructions),
 * positioning_line.c (requests). Main only.
 */
#ifndef POSITIONING_PRIVATE_H
#define POSITIONING_PRIVATE_H

#include "positioning.h"

/* Hears, executes what has come, and sends. Returns when to call again at the latest. */
uint64_t positioning_serve(struct pos_unit *unit);

/* Answers what has been executed in this pass: last, as pulses that are to change do not wait for it. */
void positioning_answer(struct pos_unit *unit);

/* Sets up the server. */
void positioning_init_line(struct pos_unit *unit);

#endif
