/*
 * Contracts of what motion_leg.c keeps for itself: used by motion_leg.acsl, proved with motion_leg_segment.acsl.
 */
#ifndef LEG_PARTS_H
#define LEG_PARTS_H

#include "legs.h"

/*@ requires slope <= 0x40000000000000 && accel <= 0x40000000;
    assigns \nothing;
    ensures \result <= slope + accel;
*/
static uint64_t position_after(uint64_t slope, uint32_t accel, uint32_t fraction);

/*@ requires slope <= 0x40000000000000 && accel <= 0x40000000;
    assigns \nothing;
    ensures slope <= \result <= slope + 2 * accel;
    ensures accel == 0 ==> \result == slope;
*/
static uint64_t slope_after(uint64_t slope, uint32_t accel, uint32_t fraction);

/*@ requires \valid_read(leg) && \valid(segment) && \separated(leg, segment) && is_leg(leg);
    assigns segment->tick, segment->residual, segment->slope, segment->accel;
    ensures segment->accel == leg->accel;
    ensures leg->from.quanta <= segment->residual <= leg->from.quanta + leg->from_slope + leg->accel;
    ensures leg->from_slope <= segment->slope <= leg->from_slope + 2 * leg->accel;
    ensures leg->accel == 0 ==> segment->slope == leg->from_slope;
*/
static void segment_from_start(const struct motion_leg *leg, struct step_segment *segment);

/*@ requires \valid_read(leg) && \valid(segment) && \separated(leg, segment) && is_leg(leg) && is_timed(leg);
    requires leg->to_slope < leg->from_slope && leg->accel >= 1;
    assigns segment->tick, segment->residual, segment->slope, segment->accel;
    ensures segment->accel == -leg->accel;
    ensures \old(leg->to_slope) <= segment->slope <= \old(leg->from_slope) + 4 * \old(leg->accel);
*/
static void segment_from_end(const struct motion_leg *leg, struct step_segment *segment);

/*@ requires \valid_read(leg) && \valid_read(segment) && is_leg(leg) && segment->slope >= 1;
    assigns \nothing;
*/
static uint32_t first_interval(const struct motion_leg *leg, const struct step_segment *segment);

#endif
