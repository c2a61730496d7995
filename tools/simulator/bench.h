/*
 * `rkm04-host bench`: how fast the step generator and the simulation are on this machine, as one JSON object on
 * standard output. Takes some seconds.
 */
#ifndef BENCH_H
#define BENCH_H

#include "complain.h"

enum exit_status bench_print(void);

#endif
