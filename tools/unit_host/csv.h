/*
 * The two tables: a line for each STEP pulse, and a line for each trace event. Ticks count from the start of the
 * simulation.
 */
#ifndef CSV_H
#define CSV_H

#include "outfile.h"
#include "timeline.h"
#include "unit_kind.h"

/* Steps: `# tick_hz=84000000`, `tick,motor,position`, then the pulses. */
void csv_begin_steps(struct outfile *file);
void csv_put_step(struct outfile *file, const struct timeline_event *event);

/* Trace: `tick,motor,event,value`, then the events, with the words of the kind of unit; `position` is a position that
 * was written. */
void csv_begin_trace(struct outfile *file);
void csv_put_trace(struct outfile *file, const struct timeline_event *event, const struct unit_kind *kind);
void csv_put_position(struct outfile *file, const struct timeline_event *event);

#endif
