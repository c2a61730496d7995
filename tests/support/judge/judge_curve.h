/*
 * The judge's own idea of a move: when each pulse is due, from the contract of the step times (motion.md) alone.
 *
 * Comes in: an order, and the pulses at which stops and changes of speed take effect. Goes out: the time of each pulse.
 * Nothing here is the firmware's but the struct of the order. Squares of speeds are w in (steps/s)^2; at whole steps
 * they are whole numbers and kept exact. Times are in ticks from the start of the move, in long double: of the 64 bits
 * of a PC's, 40 stand before the point at most, so a time is good to 10^-6 ticks for moves of up to 2^30 steps.
 */
#ifndef JUDGE_CURVE_H
#define JUDGE_CURVE_H

#include <stdbool.h>
#include <stdint.h>

#include "motion_order.h"

/* Braking and a trapezoid for each section. */
enum {
    JUDGE_LEGS_MAX = 4 * MOTION_SECTIONS
};

/* Constant acceleration from one position to another; anchored at its slow end, which is the exact one. */
struct judge_leg {
    long double from; /* steps */
    long double to;
    long double anchor;
    long double anchor_w;
    long double accel; /* steps/s^2, signed; 0: cruise */
    long double start; /* ticks */
};

struct judge_curve {
    struct motion_order order; /* with the speeds in force */
    struct judge_leg legs[JUDGE_LEGS_MAX];
    unsigned count;
    unsigned present;   /* the leg asked for last; pulses are asked for in rising order */
    uint64_t last;      /* ordinal of the last pulse; UINT64_MAX: none */
    long double most_w; /* the greatest and the least w of all legs */
    long double least_w;
    bool fixed; /* it is being stopped: nothing changes it any more */
};

/* The curve of a whole move. */
void judge_curve_begin(struct judge_curve *curve, const struct motion_order *order);

/* A stop takes effect at a pulse that is due on the curve: from there down the ramp to S. */
void judge_curve_stop(struct judge_curve *curve, uint64_t pulse);

/* No pulse comes after this one. */
void judge_curve_halt(struct judge_curve *curve, uint64_t pulse);

/* A change of speed takes effect at a pulse that is due on the curve. */
void judge_curve_change_speed(struct judge_curve *curve, uint64_t pulse, uint32_t speed_steps_per_s);

/* When a pulse, not above `last`, is due; and the leg that it stands on. Not below one asked for before. */
long double judge_curve_tick(struct judge_curve *curve, uint64_t pulse);
const struct judge_leg *judge_curve_leg(struct judge_curve *curve, uint64_t pulse);

/* The greatest w from which the motor can still brake to S on the way after a pulse. */
long double judge_curve_stoppable_w(const struct judge_curve *curve, uint64_t pulse);

#endif
