/*
 * `gve134-host sim`: plays a vector file to a unit in virtual time, and writes what the unit did.
 */
#ifndef GVE_SIM_H
#define GVE_SIM_H

#include "complain.h"

/* Does what follows `sim` on the command line. */
enum exit_status gve_sim(int count, char *const arguments[]);

#endif
