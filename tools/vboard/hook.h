/*
 * What Unicorn calls: before each instruction, which counts cycles and finds the moment at which something else is due;
 * at an exception that Unicorn sees itself; at a memory access that leads nowhere. Emulation is only ever stopped
 * before an instruction, never inside an IT block.
 */
#ifndef HOOK_H
#define HOOK_H

#include <stdbool.h>

#include "board.h"

/* False: there is not memory enough. */
bool hook_add_all(struct board *board);

/* Whether emulation must stop at the next boundary for something other than an exception. */
static inline bool hook_wants_stop(const struct board *board)
{
    return board->report.end != REPORT_RUNS || board->reset.wanted != RESET_NONE || board->faults.due > 0 ||
           board->memory.changed || board->flash.code_changed ||
           flash_watches_reads(&board->flash) != board->flash.read_protected;
}

#endif
