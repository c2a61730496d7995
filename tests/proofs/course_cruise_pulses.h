/*
 * Contracts of pulses in a cruise in path_course.c, proved with path_course_place.acsl.
 */
#ifndef COURSE_CRUISE_PULSES_H
#define COURSE_CRUISE_PULSES_H

#include "course_cruises.h"

/*@ requires \valid_read(course) && course_fits(course) && 1 <= steps <= course->length && pulse <= steps;
    assigns \nothing;
    ensures value(\result) <= course->length * 0x10000000000000000;
    ensures divided_down(pulse * course->length * 0x10000000000000000, steps, value(\result));
*/
static struct wide place_of(const struct path_course *course, uint32_t steps, uint32_t pulse);

/*@ requires slope.high <= 0x70000000000000;
    assigns \nothing;
    ensures \result <= 0x7000000000000100;
    ensures \result == slope.high * 256 + (slope.low / 0x80000000000000 + 1) / 2;
*/
static uint64_t slope256_of(struct wide slope);

/*@ requires \valid_read(course) && course_fits(course) && 1 <= steps <= course->length && pulse <= steps;
    requires \valid_read(leg) && cruise_fits(leg) && leg->slope.high <= 0x70000000000000;
    requires value(leg->begin) * steps <= pulse * course->length * 0x10000000000000000;
    assigns \nothing;
    ensures leg->time.high <= \result.ticks < 0xD000000000000000 && \result.slope256 <= 0x7000000000000100;
*/
static struct path_pulse cruise_pulse(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                      uint32_t pulse);

#endif
