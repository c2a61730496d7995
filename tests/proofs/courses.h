/*
 * Courses of a path: what path_course.c keeps of a vector, and what it asks of an entry and a goal. Speeds are twice
 * their squares, as a grain changes those by one.
 */
#ifndef COURSES_H
#define COURSES_H

#include "path_roots.h"
#include "path_speeds.h"
#include "path_vectors.h"

#include "path_course.h"

/*@ logic integer course_way(struct path_course *c) = c->grains_per_step * c->length;
    predicate course_fits(struct path_course *c) =
        1 <= c->length <= 0x7FFFFFFF && 2048 <= c->grains_per_step <= 0x20000000000 &&
        value(c->whole) == course_way(c) && is_ready(c->per_length) && number(c->per_length) == c->length;

    logic integer lesser(integer a, integer b) = a < b ? a : b;
    logic integer greater(integer a, integer b) = a > b ? a : b;
    logic integer change_of(integer a, integer b) = a < b ? b - a : a - b;
    logic integer limit_of(struct path_goal *g) = 2 * greater(square(g->speed), g->exit_speed2);
    logic integer fall_from(struct path_entry *e, struct path_goal *g) =
        lesser(2 * e->speed2, greater(limit_of(g), 2 * square(g->start_speed)));
    predicate is_reached(struct path_entry *e, struct path_goal *g, integer left) =
        g->rests ? 2 * e->speed2 - 2 * g->exit_speed2 <= left :
        2 * e->speed2 > limit_of(g) ?
            2 * e->speed2 - fall_from(e, g) + limit_of(g) - 2 * g->exit_speed2 <= left :
            change_of(2 * e->speed2, 2 * g->exit_speed2) <= left;
    predicate is_braked(struct path_entry *e, struct path_goal *g, integer left) =
        g->start_speed == 0 && 2 * e->speed2 == left;
    predicate goal_fits(struct path_entry *e, struct path_goal *g, integer left) =
        2 * e->speed2 <= twice_speed2_most && 2 * g->exit_speed2 <= twice_speed2_most &&
        g->speed <= PATH_SPEED_MAX && g->start_speed <= PATH_SPEED_MAX &&
        0 <= left && left % 2 == 0 && is_reached(e, g, left) &&
        (!g->rests && g->speed == 0 && g->exit_speed2 == 0 ==> is_braked(e, g, left));

    predicate is_profile(integer enter, integer turn, integer cruise, integer exit, integer left) =
        exit <= cruise <= turn && change_of(enter, turn) + cruise - exit <= left &&
        (cruise == 0 ==> change_of(enter, turn) == left);
*/
#endif
