/*
 * Where a path is at a tick: contracts of path_change.c, proved with path_change_way.acsl. To be included after struct
 * look.
 */
#ifndef CHANGE_WAYS_H
#define CHANGE_WAYS_H

#include "courses.h"

/* A leg, and how long the path has been on it at a tick. */
/*@ predicate leg_moves(struct path_leg *l) =
        -PATH_ACCEL_MAX <= l->accel <= PATH_ACCEL_MAX && l->slope.high <= 0x70000000000000 &&
        l->time.high <= 0x8000000000000000;
    logic integer since(integer tick, integer begin) = begin < tick ? tick - begin : 0;
    predicate speeds_on(struct path_leg *l, integer ticks) =
        0 < l->accel ==> l->slope.high + l->accel * ticks < 0x1000000000000000;
*/

/*@ assigns \nothing;
    ensures \result <==> time.high >= tick;
*/
static bool is_due(struct wide time, uint64_t tick);

/*@ requires \valid_read(course) && course->legs <= 3;
    assigns \nothing;
    ensures \result == &course->leg[0] || (2 <= course->legs && \result == &course->leg[1]) ||
        (3 <= course->legs && \result == &course->leg[2]);
*/
static const struct path_leg *leg_at(const struct path_course *course, uint64_t tick);

/*@ requires \valid_read(look) && \valid_read(look->leg) && \valid(rest) && leg_moves(look->leg);
    requires speeds_on(look->leg, since(look->tick, look->leg->time.high));
    assigns *rest;
    ensures \result < 0xD000000000000000 && *rest < STEP_QUANTA;
    ensures look->leg->accel == 0 ==> \result * STEP_QUANTA + *rest ==
        look->leg->slope.high * since(look->tick, look->leg->time.high);
*/
static uint64_t way_at(const struct look *look, uint64_t *rest);

#endif
