/*
 * `positioning-host sim`: plays a script of instructions to a unit in virtual time, and writes what the unit did.
 */
#ifndef POS_SIM_H
#define POS_SIM_H

#include "complain.h"

/* Does what follows `sim` on the command line. */
enum exit_status pos_sim(int count, char *const arguments[]);

/* Whether a script can be read; prints how many lines it has, as JSON. */
enum exit_status pos_sim_check(const char *path);

#endif
