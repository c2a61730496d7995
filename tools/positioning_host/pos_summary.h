/*
 * The summary of a simulation, as one JSON object on standard output.
 */
#ifndef POS_SUMMARY_H
#define POS_SUMMARY_H

#include "pos_script.h"
#include "run.h"

void pos_summary_print(const struct run *run, const struct pos_script *script);

#endif
