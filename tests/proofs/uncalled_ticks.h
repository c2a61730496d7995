/*
 * The tick of a pulse of a path, which is not asked for in what is proved.
 */
#ifndef UNCALLED_TICKS_H
#define UNCALLED_TICKS_H

#include "path_segment.h"

/*@ requires \false;
    assigns \nothing;
*/
uint64_t path_segment_tick(const struct path_pulse *pulse);

#endif
