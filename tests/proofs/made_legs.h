/*
 * Legs as motion_legs.c makes them: contracts proved with motion_legs_leg.acsl.
 */
#ifndef MADE_LEGS_H
#define MADE_LEGS_H

#include "progress.h"

/* The leg that comes next begins where the progress stands; it may be empty. */
/*@ predicate has_leg(struct motion_progress *progress) =
        has_ramps(progress->profile) && is_place(progress->place) &&
        (progress->leg == 0 ? is_place(progress->profile.corner_a) &&
            quanta(progress->place) <= quanta(progress->profile.corner_a) &&
            progress->profile.corner_a.step - progress->place.step <= 0xFFFFFFFF :
        progress->leg == 1 ? is_place(progress->profile.corner_b) &&
            quanta(progress->place) <= quanta(progress->profile.corner_b) :
            progress->leg == 2 && is_same(progress->place, progress->profile.corner_b) &&
            progress->profile.corner_b.step * STEP_QUANTA + progress->profile.corner_b.quanta <=
                progress->profile.end * STEP_QUANTA &&
            progress->profile.end - progress->profile.corner_b.step <= 0xFFFFFFFF);
    predicate is_at_end(integer leg, struct motion_profile profile, struct motion_place place) =
        leg == 0 ? is_same(place, profile.corner_a) :
        leg == 1 ? is_same(place, profile.corner_b) : is_step(place, profile.end);
    predicate is_leg_made(struct motion_leg leg) =
        is_place(leg.from) && is_place(leg.to) && quanta(leg.from) <= quanta(leg.to) &&
        leg.accel <= STEP_ACCEL_MAX * STEP_ACCEL_PER_ACCEL && is_slope(leg.from_slope) && is_slope(leg.to_slope) &&
        leg.pulse_twice_speed2 <= 0x10000000000 && leg.start.ticks < 0x8000000000000000 &&
        (leg.accel >= 1 ==> leg.start.ticks <= leg.end.ticks &&
            is_ramp_time(fractions(leg.end) - fractions(leg.start), leg.accel,
                \abs(leg.to_slope - leg.from_slope)));
    predicate has_pulses(struct motion_place from, struct motion_place to) = to.step - from.step <= 0xFFFFFFFF;
    predicate begins_at(struct motion_leg leg, struct motion_place place) = is_same(leg.from, place);
    predicate lasts_from(struct motion_leg leg, integer start) = leg.end.ticks <= start + leg_ticks_max;
    predicate has_no_pulse(struct motion_leg leg) = leg.to.step == leg.from.step;
    predicate is_part(integer number, struct motion_leg leg, struct motion_place corner) =
        number == 1 && is_piece(leg, corner);
    predicate ends_well(integer number, struct motion_leg leg, struct motion_profile profile) =
        is_part(number, leg, profile.corner_b) || is_at_end(number, profile, leg.to);
    lemma begins_at: \forall struct motion_leg *leg, struct motion_place place;
        is_same(leg->from, place) ==> begins_at(*leg, place);
    lemma lasts_from: \forall struct motion_leg *leg, integer start; is_lasting(leg, start) ==> lasts_from(*leg, start);
    lemma leg_made: \forall struct motion_leg *leg; is_leg(leg) && is_timed(leg) ==> is_leg_made(*leg);
    lemma made_leg: \forall struct motion_leg *leg; is_leg_made(*leg) ==> is_leg(leg) && is_timed(leg);
*/

/*@ requires \valid(progress) && knows_slope(progress) && has_leg(progress);
    requires !is_at_end(progress->leg, progress->profile, progress->place);
    requires progress->time.ticks < 0x8000000000000000;
    assigns progress->twice_speed2, progress->slope;
    ensures knows_slope(progress) && is_leg_made(\result);
    ensures begins_at(\result, \old(progress->place));
    ensures has_pulses(\result.from, \result.to) && lasts_from(\result, \old(progress->time.ticks));
    ensures ends_well(\old(progress->leg), \result, \old(progress->profile));
*/
static struct motion_leg make_leg(struct motion_progress *progress);

/*@ requires \valid_read(progress) && progress->leg <= 2;
    assigns \nothing;
    ensures \result <==> is_at_end(progress->leg, progress->profile, progress->place);
*/
static bool is_leg_empty(const struct motion_progress *progress);

#endif
