/*
 * Contracts of motion_profile.h, proved with motion_profile.acsl. Who includes this says first what gain_of is: its
 * formula, or nothing where gains are only compared.
 */
#ifndef PROFILES_H
#define PROFILES_H

#include "lower.h"
#include "motion_endless.h"
#include "motion_profile.h"
#include "places.h"

/*@ logic integer speed2_max = 160000000000;
    logic integer square_of(integer x) = x * x;
    logic integer least(integer a, integer b) = a < b ? a : b;
    logic integer most(integer a, integer b) = a > b ? a : b;
    predicate speed_in_range(integer speed) = 1 <= speed <= MOTION_SPEED_MAX;
    predicate speed2_in_range(integer speed2) = 1 <= speed2 <= speed2_max;

    logic integer floor_of(integer jumps, integer limit, integer start) = jumps != 0 ? most(limit, start) : limit;
    logic integer jump_of(integer enter, integer exit, integer limit, integer start, integer gain) =
        enter > limit ? (enter <= most(limit, start) ? limit : enter) :
            most(enter, least(least(limit, start), exit + gain));
    logic integer enter_at(integer jumps, integer enter, integer exit, integer limit, integer start, integer gain) =
        jumps != 0 ? jump_of(enter, exit, limit, start, gain) : enter;
    predicate meets(integer enter, integer exit, integer limit, integer floor, integer gain) =
        enter <= limit ? exit <= limit && exit - enter <= gain && enter - exit <= gain :
            exit <= enter && enter - most(floor, exit) + (most(limit, exit) - exit) <= gain;
    predicate in_reach(integer jumps, integer enter, integer exit, integer limit, integer start, integer gain) =
        meets(enter_at(jumps, enter, exit, limit, start, gain), exit, limit, floor_of(jumps, limit, start), gain);

    predicate span_in_range(struct motion_span span) =
        speed_in_range(span.speed_steps_per_s) && speed_in_range(span.start_speed_steps_per_s) &&
        1 <= span.accel_steps_per_s2 <= STEP_ACCEL_MAX &&
        1 <= span.steps <= MOTION_ENDLESS_STEPS && span.begin <= 0x1000000000000 &&
        speed2_in_range(span.enter_speed2) && speed2_in_range(span.exit_speed2);
    predicate span_in_reach(struct motion_span span) =
        in_reach(span.jumps, span.enter_speed2, span.exit_speed2, square_of(span.speed_steps_per_s),
            square_of(span.start_speed_steps_per_s), gain_of(span.accel_steps_per_s2, span.steps));

    predicate is_distance_of(integer steps, integer per_step, integer change) = steps * per_step <= change + per_step;
    predicate is_ramp_of(integer steps, integer per_step, integer change) = steps * per_step <= change;
    predicate has_speeds(struct motion_profile profile) =
        2 <= profile.enter <= 2 * speed2_max && 2 <= profile.turn <= 2 * speed2_max &&
        2 <= profile.cruise <= 2 * speed2_max && 2 <= profile.exit <= 2 * speed2_max;
    predicate has_corners(struct motion_profile profile) =
        is_place(profile.corner_a) && is_place(profile.corner_b) &&
        profile.begin * STEP_QUANTA <= quanta(profile.corner_a) <= quanta(profile.corner_b) <=
            profile.end * STEP_QUANTA;
*/

/*@ requires speed_steps_per_s <= MOTION_SPEED_MAX;
    assigns \nothing;
    ensures \result == square_of(speed_steps_per_s) && \result <= speed2_max;
    ensures 1 <= speed_steps_per_s ==> 1 <= \result;
*/
uint64_t motion_square(uint32_t speed_steps_per_s);

/*@ requires accel_steps_per_s2 >= 1;
    assigns \nothing;
    ensures \result == gain_of(accel_steps_per_s2, steps) && 0 <= \result <= 0x1000000000000000;
*/
uint64_t motion_gain(uint32_t accel_steps_per_s2, uint64_t steps);

/*@ requires \valid_read(span) && span_in_range(*span);
    assigns \nothing;
    ensures \result == floor_of(span->jumps, square_of(span->speed_steps_per_s),
        square_of(span->start_speed_steps_per_s));
    ensures speed2_in_range(\result);
*/
uint64_t motion_profile_floor(const struct motion_span *span);

/*@ requires \valid_read(span) && span_in_range(*span);
    assigns \nothing;
    ensures \result == enter_at(span->jumps, span->enter_speed2, span->exit_speed2, square_of(span->speed_steps_per_s),
        square_of(span->start_speed_steps_per_s), gain_of(span->accel_steps_per_s2, span->steps));
    ensures speed2_in_range(\result);
*/
uint64_t motion_profile_enter(const struct motion_span *span);

/*@ requires \valid_read(span) && span_in_range(*span) && span_in_reach(*span);
    assigns \nothing;
    ensures \result.begin == span->begin && \result.end == span->begin + span->steps;
    ensures \result.accel_steps_per_s2 == span->accel_steps_per_s2;
    ensures has_speeds(\result) && has_corners(\result);
    ensures \result.exit <= \result.cruise;
    ensures is_distance_of(\result.end - \result.corner_b.step, 4 * span->accel_steps_per_s2,
        \result.cruise - \result.exit);
    ensures \result.cruise <= most(2 * square_of(span->speed_steps_per_s), \result.exit);
    ensures is_ramp_of(\result.corner_a.step - \result.begin, 4 * span->accel_steps_per_s2,
        2 * most(span->enter_speed2, square_of(span->speed_steps_per_s)));
*/
struct motion_profile motion_profile_fit(const struct motion_span *span);

/*@ requires \valid_read(span) && span_in_range(*span) && span->exit_speed2 <= span->enter_speed2;
    requires span->enter_speed2 - span->exit_speed2 <= gain_of(span->accel_steps_per_s2, span->steps);
    assigns \nothing;
    ensures \result.begin == span->begin && \result.end == \result.corner_a.step;
    ensures \result.accel_steps_per_s2 == span->accel_steps_per_s2;
    ensures has_speeds(\result) && is_place(\result.corner_a) && \result.corner_b == \result.corner_a;
    ensures \result.cruise == \result.exit;
    ensures is_distance_of(\result.end - \result.corner_b.step, 4 * span->accel_steps_per_s2,
        \result.cruise - \result.exit);
    ensures span->begin * STEP_QUANTA <= quanta(\result.corner_a) <= (span->begin + span->steps) * STEP_QUANTA;
    ensures span->enter_speed2 - span->exit_speed2 == gain_of(span->accel_steps_per_s2, span->steps) ==>
        quanta(\result.corner_a) == (span->begin + span->steps) * STEP_QUANTA;
    ensures is_ramp_of(\result.corner_a.step - \result.begin, 4 * span->accel_steps_per_s2,
        2 * span->enter_speed2);
*/
struct motion_profile motion_profile_fit_stop(const struct motion_span *span);

#endif
