/*
 * `rkm04-host opcodes`: the firmware's tables as one JSON object on standard output, for tools and checks: opcodes,
 * names in trace files (events, stops, errors), states of a motor, message numbers, the timer's rate and the version.
 */
#ifndef OPCODES_H
#define OPCODES_H

#include "complain.h"

enum exit_status opcodes_print(void);

#endif
