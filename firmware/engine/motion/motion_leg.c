#include "motion_leg.h"

#include "step_generator.h"
#include "step_scale.h"

/* (speed * STEP_SLOPE_PER_SPEED)^2, where STEP_SLOPE_PER_SPEED^2 = 2 * STEP_ACCEL_PER_ACCEL *
 * STEP_QUANTA. */
uint64_t motion_leg_slope(uint64_t twice_speed2)
{
    return wide_root_nearest(wide_shift_left(wide_multiply(twice_speed2, STEP_QUANTA), STEP_FRACTION_BITS));
}

static uint64_t slope_change(const struct motion_leg *leg)
{
    return leg->to_slope > leg->from_slope ? leg->to_slope - leg->from_slope : leg->from_slope - leg->to_slope;
}

void motion_leg_set_end(struct motion_leg *leg)
{
    if (leg->accel != 0) {
        leg->end = motion_time_add(leg->start, (struct wide){.low = slope_change(leg)}, 2U * (uint64_t)leg->accel);
    } else {
        leg->end = motion_time_add(leg->start, motion_place_distance(leg->from, leg->to), leg->from_slope);
    }
}

uint64_t motion_leg_pulses(const struct motion_leg *leg)
{
    return leg->to.step - leg->from.step;
}

/* Position and slope at `fraction` of a tick after a slow end with `slope`. */
static uint64_t position_after(uint64_t slope, uint32_t accel, uint32_t fraction)
{
    return wide_scale(slope + wide_scale(accel, fraction), fraction);
}

static uint64_t slope_after(uint64_t slope, uint32_t accel, uint32_t fraction)
{
    return slope + wide_scale(2U * (uint64_t)accel, fraction);
}

/* Cruise and acceleration: the slow end is the start; the segment's tick is the first whole one
 * after it. */
static void segment_from_start(const struct motion_leg *leg, struct step_segment *segment)
{
    uint32_t fraction = 0U - leg->start.fraction;
    segment->tick = (uint32_t)motion_time_up(leg->start);
    segment->residual = leg->from.quanta + position_after(leg->from_slope, leg->accel, fraction);
    segment->slope = slope_after(leg->from_slope, leg->accel, fraction);
    segment->accel = (int32_t)leg->accel;
}

/* Braking: the slow end is the end, seen back from it; the segment's tick is the last whole one
 * before the start. The products wrap, the residual is right modulo 2^64. */
static void segment_from_end(const struct motion_leg *leg, struct step_segment *segment)
{
    uint64_t ticks = leg->end.ticks - leg->start.ticks;
    uint64_t slope = slope_after(leg->to_slope, leg->accel, leg->end.fraction);
    uint64_t distance =
        position_after(leg->to_slope, leg->accel, leg->end.fraction) + ticks * (slope + leg->accel * ticks);
    segment->tick = (uint32_t)leg->start.ticks;
    segment->residual = motion_leg_pulses(leg) * STEP_QUANTA + leg->to.quanta - distance;
    segment->slope = slope + 2U * leg->accel * ticks;
    segment->accel = -(int32_t)leg->accel;
}

/* About when the first pulse comes: at the speed of the beginning, where that does not change much
 * until then; else the speed at the first pulse gives the time. A residual up to a step past the
 * pulse means at once; one that wraps is negative: more than a step is left. */
static uint32_t first_interval(const struct motion_leg *leg, const struct step_segment *segment)
{
    uint64_t distance =
        segment->residual >= STEP_QUANTA && segment->residual <= 2U * STEP_QUANTA ? 0 : STEP_QUANTA - segment->residual;
    uint64_t ticks = distance / segment->slope;
    if (leg->accel == 0 || leg->accel * ticks < segment->slope / 8U) {
        return (uint32_t)ticks;
    }
    uint64_t slope = motion_leg_slope(leg->pulse_twice_speed2);
    uint64_t change = slope > segment->slope ? slope - segment->slope : segment->slope - slope;
    return (uint32_t)(change / (2U * (uint64_t)leg->accel));
}

struct step_segment motion_leg_segment(const struct motion_leg *leg)
{
    struct step_segment segment = {.steps = (uint32_t)motion_leg_pulses(leg)};
    if (leg->accel != 0 && leg->to_slope < leg->from_slope) {
        segment_from_end(leg, &segment);
    } else {
        segment_from_start(leg, &segment);
    }
    step_generator_aim(&segment, first_interval(leg, &segment));
    segment.pace_ticks = leg->accel == 0 ? (uint32_t)(STEP_QUANTA / leg->from_slope) : 0U;
    return segment;
}
