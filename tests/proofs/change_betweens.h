/*
 * Places between steps in a cruise: contracts of path_change.c, proved with path_change_betweens.acsl. To be included
 * after struct look.
 */
#ifndef CHANGE_BETWEENS_H
#define CHANGE_BETWEENS_H

#include "change_steps.h"

/* A cruise that a place is asked of: it is not far beyond its course's end at the tick. */
/*@ predicate way_within(integer place, integer grains, integer way) =
        (way + 2) * grains + place <= grains * 0x7FFFFFFF;
    predicate cruise_asked(struct path_course *c, struct path_leg *l, integer tick) =
        \forall integer way; 0 <= way && way * STEP_QUANTA <= l->slope.high * since(tick, l->time.high) ==>
            way_within(value(l->place), c->grains_per_step, way);
    logic integer tick_on(struct path_leg *l, integer tick) = tick > l->time.high ? tick : l->time.high + 1;
    predicate cruise_looks(struct path_course *c, struct path_leg *l, integer tick) =
        l->accel == 0 ==> leg_moves(l) && cruise_asked(c, l, tick_on(l, tick));
    predicate cruises_asked(struct path_course *c, integer tick) =
        legs_asked(c) && (1 <= c->legs ==> cruise_looks(c, &c->leg[0], tick)) &&
        (2 <= c->legs ==> cruise_looks(c, &c->leg[1], tick)) && (3 <= c->legs ==> cruise_looks(c, &c->leg[2], tick));
*/

/* The place is no earlier than the leg's beginning. */
/*@ requires \valid_read(look) && \valid_read(look->course) && \valid_read(look->leg) && leg_moves(look->leg);
    requires look->leg->accel == 0 && 2048 <= look->course->grains_per_step <= 0x20000000000;
    requires 2048 <= grains_per_step <= 0x20000000000;
    requires cruise_asked(look->course, look->leg, look->tick);
    requires value(look->leg->begin) * look->course->grains_per_step <= value(look->leg->place) * 0x10000000000000000;
    assigns \nothing;
    ensures value(\result) % 2 == 0 && value(\result) <= grains_per_step * 0x7FFFFFFF;
    ensures value(look->leg->begin) * grains_per_step <= value(\result) * 0x10000000000000000;
*/
static struct wide between_steps(const struct look *look, uint64_t grains_per_step);

/*@ requires \valid_read(look.course) && cruises_asked(look.course, look.tick) && leg_of(look.course, look.leg);
    requires 2048 <= grains_per_step <= 0x20000000000;
    requires \valid(entry) && \separated(entry, look.course);
    assigns *entry;
    ensures \result ==> entry->time.high < 0xD000000000000000 && 2 * entry->speed2 <= twice_speed2_most;
    ensures \result ==> value(entry->place) % 2 == 0 && value(entry->place) <= grains_per_step * 0x7FFFFFFF;
    ensures !\result ==> entry->speed2 == \old(entry->speed2) && value(entry->place) == \old(value(entry->place));
*/
static bool find_between(struct look look, uint64_t until_tick, uint64_t grains_per_step, struct path_entry *entry);

#endif
