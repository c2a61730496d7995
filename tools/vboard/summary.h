/*
 * The summary of a run on standard output, one JSON object.
 */
#ifndef SUMMARY_H
#define SUMMARY_H

#include "board.h"

void summary_print(struct board *board);

#endif
