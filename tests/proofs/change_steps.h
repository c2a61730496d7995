/*
 * The first step from a tick on and the one before: contracts of path_change.c, proved with path_change_steps.acsl and
 * path_change_early.acsl. To be included after struct look.
 */
#ifndef CHANGE_STEPS_H
#define CHANGE_STEPS_H

#include "change_ways.h"
#include "course_steps.h"

/*@ logic struct path_leg *last_leg(struct path_course *c) = &c->leg[c->legs - 1];
    predicate leg_of(struct path_course *c, struct path_leg *l) =
        l == &c->leg[0] || (2 <= c->legs && l == &c->leg[1]) || (3 <= c->legs && l == &c->leg[2]);
    predicate course_asked(struct path_course *c) =
        legs_asked(c) && 1 <= c->legs &&
        value(c->end) <= value(last_leg(c)->end) && value(c->leg[0].place) <= value(c->end);
    predicate looks_at(struct path_course *c, struct path_leg *l, integer tick) =
        course_asked(c) && leg_of(c, l) && leg_moves(l) && speeds_on(l, since(tick, l->time.high));
*/

/*@ requires \valid_read(look) && \valid_read(look->course) && looks_at(look->course, look->leg, look->tick);
    requires \valid(step) && \valid(entry) && \separated(step, entry) && \separated(step, look, look->course);
    requires \separated(entry, look, look->course);
    assigns *step, *entry;
    ensures 1 <= *step && (*step - 1) * look->course->grains_per_step <= value(last_leg(look->course)->end);
    ensures \result ==> look->tick <= entry->time.high && 2 * entry->speed2 <= twice_speed2_most &&
        value(entry->place) == *step * look->course->grains_per_step &&
        value(look->course->leg[0].place) < value(entry->place) <= value(look->course->end);
*/
static bool find_step(const struct look *look, uint64_t *step, struct path_entry *entry);

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
