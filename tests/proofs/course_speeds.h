/*
 * Contracts of the speeds that path_course.c keeps, proved with path_course_speeds.acsl.
 */
#ifndef COURSE_SPEEDS_H
#define COURSE_SPEEDS_H

#include "courses.h"

/*@ predicate slope_fits(integer twice_speed2, struct wide slope) =
        twice_speed2 <= twice_speed2_most && slope.high <= 0x70000000000000 &&
        (1 <= twice_speed2 ==> 0x100000 <= slope.high);
    predicate speed_fits(struct path_speed *s) =
        slope_fits(s->twice_speed2, s->slope) && s->pace.high < 0x40000000000;
    predicate speeds_fit(struct path_speeds *s) =
        \valid(s) && 0 <= s->last <= 1 && speed_fits(&s->known[0]) && speed_fits(&s->known[1]);
*/

/*@ requires speeds_fit(speeds) && twice_speed2 <= twice_speed2_most;
    assigns *speeds;
    ensures speeds_fit(speeds);
    ensures \result == &speeds->known[speeds->last] && \valid(\result);
    ensures \result->twice_speed2 == twice_speed2 && slope_fits(twice_speed2, \result->slope);
*/
static struct path_speed *speed_of(struct path_speeds *speeds, uint64_t twice_speed2);

/*@ requires speeds_fit(speeds) && 1 <= twice_speed2 <= twice_speed2_most;
    assigns *speeds;
    ensures speeds_fit(speeds);
    ensures \result.high < 0x40000000000;
*/
static struct wide pace_of(struct path_speeds *speeds, uint64_t twice_speed2);

#endif
