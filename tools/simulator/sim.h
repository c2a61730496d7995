/*
 * What `rkm04-host sim` does: reads programs and inputs, lets the unit run, and writes what it did.
 */
#ifndef SIM_H
#define SIM_H

#include "complain.h"
#include "options.h"

enum exit_status sim_run(const struct options *options);

#endif
