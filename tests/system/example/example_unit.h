/*
 * A unit with another language, to show what a unit needs of the engine: its door, axis.h, for each motor.
 *
 * Two motors, three orders of a letter: f runs the first motor 1000 steps forward, b back, s stops it; F, B and S are
 * for the second. A motor that runs takes only s. Input 1 stops the first, input 2 the second. Main, but for the
 * entries in `client`.
 */
#ifndef EXAMPLE_UNIT_H
#define EXAMPLE_UNIT_H

#include "axis.h"
#include "hal_run.h"

enum {
    EXAMPLE_MOTORS = 2
};

struct example_unit {
    struct axis axis[EXAMPLE_MOTORS];
    struct hal_client client;
};

/* Starts the unit, which must stay where it is. */
void example_unit_start(struct example_unit *unit);

/* Does what a letter orders; nothing if it is none of the six. */
void example_unit_take(struct example_unit *unit, char letter);

/* One pass of the main loop; an interrupt asks for the next. */
void example_unit_poll(struct example_unit *unit);

#endif
