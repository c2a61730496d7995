/*
 * Contracts of pulses on a ramp in path_course.c, proved with path_course_square.acsl,
 * path_course_root.acsl and path_course_ramp_pulse.acsl.
 */
#ifndef COURSE_RAMP_PULSES_H
#define COURSE_RAMP_PULSES_H

#include "courses.h"

/*@ predicate lies_on(struct path_course *c, struct path_leg *l, integer steps, integer pulse) =
        1 <= steps <= c->length && 0 <= pulse <= steps && value(l->place) <= value(l->end) <= course_way(c) &&
        value(l->place) * steps <= pulse * c->length * c->grains_per_step <= value(l->end) * steps;
    predicate ramp_squares(struct path_leg *l) =
        l->twice_speed2 <= twice_speed2_most && l->slope.high <= 0x70000000000000 && -0x40000000 <= l->accel &&
        l->time.high <= 0x8000000000000000 &&
        (0 < l->accel ==> l->twice_speed2 + value(l->end) - value(l->place) <= twice_speed2_most) &&
        (l->accel <= 0 ==> value(l->end) - value(l->place) <= l->twice_speed2);
*/

/*@ requires \valid_read(course) && course_fits(course) && \valid_read(leg) && ramp_squares(leg);
    requires lies_on(course, leg, steps, pulse);
    assigns \nothing;
    ensures value(\result) <= twice_speed2_most * 0x10000000000000000;
*/
static struct wide twice_speed2_at(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                   uint32_t pulse);

/*@ requires value(twice_speed2) <= twice_speed2_most * 0x10000000000000000;
    assigns \nothing;
    ensures \result <= 0x7000000000000000;
*/
static uint64_t root256(struct wide twice_speed2);

/*@ requires \valid_read(course) && course_fits(course) && \valid_read(leg) && ramp_squares(leg);
    requires lies_on(course, leg, steps, pulse);
    requires is_ready(course->per_accel) && 2 <= number(course->per_accel);
    assigns \nothing;
    ensures leg->time.high <= \result.ticks < 0xD000000000000000 && \result.slope256 <= 0x7000000000000000;
*/
static struct path_pulse ramp_pulse(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                    uint32_t pulse);

#endif
