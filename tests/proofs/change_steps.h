/*
 * The step before one that a change has found: a contract of path_change.c, proved with path_change_early.acsl. To be
 * included after struct look.
 */
#ifndef CHANGE_STEPS_H
#define CHANGE_STEPS_H

#include "change_ways.h"
#include "course_steps.h"

/*@ logic struct path_leg *last_leg(struct path_course *c) = &c->leg[c->legs - 1];
    predicate course_asked(struct path_course *c) =
        legs_asked(c) && 1 <= c->legs &&
        value(c->end) <= value(last_leg(c)->end) && value(c->leg[0].place) <= value(c->end);
*/

/*@ requires \valid_read(look) && \valid_read(look->course) && course_asked(look->course) && 1 <= step;
    requires (step - 1) * look->course->grains_per_step <= value(last_leg(look->course)->end);
    requires \valid(entry) && \separated(entry, look, look->course);
    assigns *entry;
    ensures \result ==> look->early_tick <= entry->time.high && entry->speed2 <= square(256 * 1500) &&
        value(entry->place) == grains_per_step * (step - 1);
    ensures !\result ==> entry->speed2 == \old(entry->speed2) && value(entry->place) == \old(value(entry->place));
*/
static bool find_early(const struct look *look, uint64_t step, uint64_t grains_per_step, struct path_entry *entry);

#endif
