/*
 * The summary of a simulation, as one JSON object on standard output.
 */
#ifndef GVE_SUMMARY_H
#define GVE_SUMMARY_H

#include "gve_player.h"
#include "run.h"

void gve_summary_print(const struct run *run, const struct gve_player *player);

#endif
