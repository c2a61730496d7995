/*
 * Vectors: what a path is made of, as a unit orders it, and what look-ahead keeps of each.
 *
 * A vector moves one to four axes along a straight line. Its place s counts steps of its longest axis, from 0 to their
 * number L; axis j is at steps[j]*s/L. All speeds and accelerations of a path are those of ds/dt.
 *
 *   speed         1/256 step/s
 *   speed2        square of a speed, 2^-16 (steps/s)^2; twice_speed2: twice that, as half values occur where ramps meet
 *   acceleration  1/128 step/s^2
 *   grain         1/(2048*acceleration) step: along a ramp twice_speed2 changes by one a grain
 *
 * So on every ramp, speed and place are whole numbers of each other, whatever came before: this is why a path can be
 * stopped, changed and gone on with for ever and stays exact.
 */
#ifndef PATH_VECTOR_H
#define PATH_VECTOR_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>

#include "base_wide.h"
#include "path_wide.h"
#include "../step/step_scale.h"

#define PATH_SPEED_UNITS 256U /* a step/s */
#define PATH_SPEED_MAX (STEP_SPEED_MAX * PATH_SPEED_UNITS)
#define PATH_ACCEL_MAX (STEP_ACCEL_MAX * STEP_ACCEL_PER_ACCEL)
#define PATH_GRAINS_PER_ACCEL UINT64_C(2048)

/* (quanta a tick)^2 for one unit of twice_speed2. */
#define PATH_SLOPE2_PER_TWICE_SPEED2 ((uint64_t)TICK_HZ * TICK_HZ / 2U)

/* Even from a stand an axis must make no step in that time: STEP_ACCEL_MAX*T^2/2 <= 1. */
#define PATH_TURN_US_MAX 500U

/* Squares of speeds and gains that stand for "more than any speed". */
#define PATH_SPEED2_ENDLESS (UINT64_C(1) << 60)

enum {
    PATH_AXES = 4
};

static_assert((uint64_t)PATH_SPEED_MAX * PATH_SPEED_MAX < UINT64_C(1) << 56, "twice a square must fit 57 bits");
static_assert(PATH_ACCEL_MAX < UINT32_C(1) << 30, "2 * acceleration must fit 31 bits, the grains of a step 41");
static_assert(((uint64_t)STEP_ACCEL_MAX * PATH_TURN_US_MAX * PATH_TURN_US_MAX) <= UINT64_C(2000000000000),
              "an axis that turns at a stand must not be too early");
static_assert(PATH_GRAINS_PER_ACCEL == UINT64_C(8) * PATH_SPEED_UNITS, "a grain must change twice_speed2 by one");

struct path_vector {
    int32_t steps[PATH_AXES]; /* -INT32_MAX to INT32_MAX, not all 0 */
    uint32_t speed;           /* not exceeded, 1 to PATH_SPEED_MAX */
    uint32_t accel;           /* 1 to PATH_ACCEL_MAX */

    /* The speed at a border is one number for the vectors on both sides, each multiplied by its own L/E: the length
     * that the ordered speeds count. E^2 = L^2 where they count steps of the longest axis; at most 3*2^62. The number
     * is 2^30 at most, in 1/256 step/s: where E is more than four times L, a border may be slower than both vectors. */
    uint64_t extent2; /* E^2, at least 1 */
    uint32_t
        border_speed; /* not exceeded where another vector joins this one's beginning, 1/256 step/s of that number */

    bool straight; /* it goes on as the vector before it: same direction, speed, acceleration; for a start speed */
};

/* A place of the caller's ring. */
struct path_section {
    struct path_vector vector;
    uint32_t length;     /* L, steps */
    bool plain;          /* E = L: speeds at borders are the vector's own */
    uint32_t turning;    /* the fewest steps of an axis that turns at its beginning; 0: none, or the path stood in it */
    uint32_t ready;      /* a speed that waits to be taken */
    uint64_t gain2;      /* what the square of the speed can gain in the vector, in terms of border speeds */
    uint64_t speed2;     /* the vector's own speed in these terms */
    uint64_t ready2;     /* the same of the speed that waits to be taken */
    uint64_t border2;    /* the most at its beginning, in these terms */
    uint64_t cap2;       /* the same, and no more than the vectors on both sides allow; set where the plan is made */
    uint64_t exit2;      /* the plan: at its end, in these terms; until it is laid what can be braked from */
    uint64_t enter2;     /* from here, set as soon as it is laid: speed2 with which it is entered, */
    uint64_t leave2;     /* with which it is left, */
    struct wide entered; /* and when it is entered: ticks, 64.64 */
};

/* Reads a vector into a section; its own numbers, that is length, gain2, speed2. border2 is border_speed alone. */
void path_section_take(struct path_section *section, const struct path_vector *vector);

/* Another acceleration. border2 is as it was. */
void path_section_set_accel(struct path_section *section, uint32_t accel);

/* border2 as border_speed and the axes that turn want it where `section` joins `before`: DIR needs turn_us from the
 * last pulse of one to the first of the other. */
void path_section_mind_turns(struct path_section *section, const struct path_section *before, uint32_t turn_us);

/* Squares of speeds, from the vector's own terms to those of the border and back, rounded down; 2^60 if it is more. */
uint64_t path_section_to_border2(const struct path_section *section, uint64_t speed2);
uint64_t path_section_to_border2_up(const struct path_section *section, uint64_t speed2);
uint64_t path_section_from_border2(const struct path_section *section, uint64_t border2);

/* Another speed for the vector waits until it is taken: what takes time has been done by then. */
static inline void path_section_ready_speed(struct path_section *section, uint32_t speed)
{
    uint64_t speed2 = (uint64_t)speed * speed;
    section->ready = speed;
    section->ready2 = section->plain ? speed2 : path_section_to_border2(section, speed2);
}

static inline void path_section_take_speed(struct path_section *section)
{
    section->vector.speed = section->ready;
    section->speed2 = section->ready2;
}

static inline void path_section_set_speed(struct path_section *section, uint32_t speed)
{
    path_section_ready_speed(section, speed);
    path_section_take_speed(section);
}

/* 1/(1024*acceleration) step: as many make a step. The square of the speed changes by one on the way. */
static inline uint64_t path_section_gain_per_step(const struct path_section *section)
{
    return PATH_GRAINS_PER_ACCEL / 2U * section->vector.accel;
}

static inline uint64_t path_section_grains_per_step(const struct path_section *section)
{
    return PATH_GRAINS_PER_ACCEL * section->vector.accel;
}

/* The end of the vector, grains. */
static inline struct wide path_section_end(const struct path_section *section)
{
    return path_wide_multiply(path_section_grains_per_step(section), section->length);
}

/* Steps of an axis, as a magnitude. */
static inline uint32_t path_section_steps(const struct path_section *section, unsigned axis)
{
    int32_t steps = section->vector.steps[axis];
    return steps < 0 ? 0U - (uint32_t)steps : (uint32_t)steps;
}

#endif
