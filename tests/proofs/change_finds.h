/*
 * Where a change is found in a section: a contract of path_change.c, proved with path_change_finds.acsl. To be included
 * after struct look.
 */
#ifndef CHANGE_FINDS_H
#define CHANGE_FINDS_H

#include "change_betweens.h"

/*@ requires \valid_read(look) && \valid_read(look->course) && looks_at(look->course, look->leg, look->tick);
    requires cruises_asked(look->course, look->tick) && 2048 <= grains_per_step <= 0x20000000000;
    requires \valid(entry) && \separated(entry, look, look->course);
    assigns *entry;
    ensures \result ==> 2 * entry->speed2 <= twice_speed2_most && value(entry->place) <= grains_per_step * 0x7FFFFFFF;
*/
static bool find_in(const struct look *look, uint64_t patience_ticks, uint64_t grains_per_step,
                    struct path_entry *entry);

#endif
