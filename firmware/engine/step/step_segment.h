/*
 * A segment: motion under one constant acceleration, the only thing that the step generator knows.
 *
 * The planner makes segments (motion/), the step interrupt walks along them. A trapezoid is three
 * segments, a stop is one; an axis of an interpolated vector would be segments with slope and accel
 * scaled by its share. A segment stands on its first pulse, so that its beginning costs the step
 * interrupt no arithmetic. Positions and slopes are in the units of step_scale.h.
 *
 * On a ramp the generator predicts an interval from the one before. The interval before a segment may have been quite
 * another one, after a rest or a change: there the pace at the first pulse stands for it. It is no longer than the
 * interval that this ramp would have had before a braking pulse, so it is as good.
 */
#ifndef STEP_SEGMENT_H
#define STEP_SEGMENT_H

#include <stdbool.h>
#include <stdint.h>

struct step_segment {
    uint64_t residual;   /* position at `tick`, less the pulses made until then, the first one included; modulo 2^64 */
    uint64_t slope;      /* quanta a tick, at `tick` */
    int32_t accel;       /* quanta a tick^2; negative when braking, 0 at constant speed */
    uint32_t tick;       /* of the first pulse */
    uint32_t pace_ticks; /* STEP_QUANTA / slope, rounded down; on a ramp also 0: the interval before it is its own */
    uint32_t steps;      /* pulses on this segment, at least 1 */
    bool marked;         /* the channel reports when this segment begins (last section of a compound move) */
};

#endif
