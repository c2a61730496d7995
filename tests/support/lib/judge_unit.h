/*
 * Between a whole unit on the host machine and the judge: what listeners and the main loop tell it.
 */
#ifndef JUDGE_UNIT_H
#define JUDGE_UNIT_H

#include <stdbool.h>
#include <stdint.h>

#include "judge.h"
#include "unit.h"

/* From the machine's listeners, whose motors count from 0 at the pins and from 1 in the trace. */
void judge_unit_step(struct judge *judge, uint64_t tick, unsigned motor, bool backward);
void judge_unit_direction(struct judge *judge, const struct unit *unit, uint64_t tick, unsigned motor, bool backward);
void judge_unit_trace(struct judge *judge, const struct unit *unit, uint64_t tick, unsigned motor,
                      enum hal_trace_event event, int64_t value);

/* Behind each unit_poll. */
void judge_unit_pass(struct judge *judge, const struct unit *unit);

#endif
