/*
 * What a section is laid for, in the numbers that it keeps: those that make a goal which fits.
 */
#ifndef GOALS_H
#define GOALS_H

#include "equals.h"

#include "course_laid.h"
#include "looks.h"

/*@ logic integer limit_with(integer exit2, integer speed) = 2 * greater(square(speed), exit2);
    logic integer fall_with(integer enter2, integer exit2, integer speed, integer start) =
        lesser(2 * enter2, greater(limit_with(exit2, speed), 2 * square(start)));
    predicate reached_with(integer enter2, integer exit2, integer speed, integer start, integer left) =
        2 * enter2 > limit_with(exit2, speed) ?
            2 * enter2 - fall_with(enter2, exit2, speed, start) + limit_with(exit2, speed) - 2 * exit2 <= left :
            change_of(2 * enter2, 2 * exit2) <= left;
    predicate goal_with(integer enter2, integer exit2, integer speed, integer start, integer left) =
        2 * enter2 <= twice_speed2_most && 2 * exit2 <= twice_speed2_most && 0 <= left && left % 2 == 0 &&
        reached_with(enter2, exit2, speed, start, left) &&
        (speed == 0 && exit2 == 0 ==> start == 0 && 2 * enter2 == left);
    predicate rest_with(integer enter2, integer exit2, integer left) =
        2 * enter2 <= twice_speed2_most && 2 * exit2 <= twice_speed2_most && 0 <= left && left % 2 == 0 &&
        2 * enter2 - 2 * exit2 <= left;

    predicate goal_of(struct path_entry *e, struct path_goal *g, integer enter2, integer exit2, integer speed,
                      integer start) =
        e->speed2 == enter2 && g->exit_speed2 == exit2 && g->speed == speed <= PATH_SPEED_MAX &&
        g->start_speed == start <= PATH_SPEED_MAX;
    lemma goal_with: \forall struct path_entry *e, struct path_goal *g, integer enter2, exit2, speed, start, left;
        goal_of(e, g, enter2, exit2, speed, start) && !g->rests && goal_with(enter2, exit2, speed, start, left) ==>
        goal_fits(e, g, left);
    lemma rest_with: \forall struct path_entry *e, struct path_goal *g, integer enter2, exit2, speed, start, left;
        goal_of(e, g, enter2, exit2, speed, start) && g->rests && rest_with(enter2, exit2, left) ==>
        goal_fits(e, g, left);
    predicate vector_same{A,B}(struct path_section *s) =
        \at(s->vector.speed, A) == \at(s->vector.speed, B) && \at(s->vector.accel, A) == \at(s->vector.accel, B) &&
        \at(s->vector.extent2, A) == \at(s->vector.extent2, B) && \at(s->length, A) == \at(s->length, B) &&
        \at(s->plain, A) == \at(s->plain, B);
    lemma way_two{A,B}: \forall struct path_section *s; vector_same{A,B}(s) ==> equal_two(
        2048 * \at(s->vector.accel, A), \at(s->length, A), 2048 * \at(s->vector.accel, B), \at(s->length, B));
    lemma way_as_was{A,B}: \forall struct path_section *s; vector_same{A,B}(s) ==>
        \at(section_way(s), A) == \at(section_way(s), B);
    lemma vector_same{A,B}: \forall struct path_section *s; vector_same{A,B}(s) && \at(vector_fits(s), A) ==>
        \at(vector_fits(s), B);
    predicate speed_same{A,B}(struct path_speed *s) =
        \at(s->twice_speed2, A) == \at(s->twice_speed2, B) && \at(s->slope.high, A) == \at(s->slope.high, B) &&
        \at(s->pace.high, A) == \at(s->pace.high, B);

    logic integer begin_in(struct path *path, integer count) =
        count == path->origin.section ? value(path->origin.entry.place) : 0;
    logic integer speed_in(struct path *path, struct path_section *s) = path->stopping ? 0 : s->vector.speed;
    logic integer start_in(struct path *path, integer count) =
        !path->stopping && count == path->origin.section ? path->start_speed : 0;
    predicate lays_well(struct path *path, struct path_section *s, integer count) =
        section_fits(s) && begin_in(path, count) <= section_way(s) && s->entered.high <= 0x4000000000000000 &&
        (path->stopping && s->exit2 == 0 ?
            rest_with(s->enter2, s->leave2, section_way(s) - begin_in(path, count)) :
            goal_with(s->enter2, s->leave2, speed_in(path, s), start_in(path, count),
                section_way(s) - begin_in(path, count)));
*/

#endif
