/*
 * The rig of the tests of a plan: one plan, and the segments that were taken from it.
 *
 * A move begins at PLAN_START; its stops and changes lie at PLAN_REPLACED. To be included by one test program alone.
 */
#ifndef PLAN_RIG_H
#define PLAN_RIG_H

#include "motion_plan.h"
#include "unity.h"

enum {
    SEGMENTS_MAX = 64,
    PLAN_START = 1000,
    PLAN_REPLACED = 500000
};

static struct motion_plan plan;
static struct step_segment segments[SEGMENTS_MAX];
static unsigned count;

static inline struct motion_order order_single(uint64_t steps, uint32_t start_speed, uint32_t speed, uint32_t accel)
{
    return (struct motion_order){
        .section = {{steps, speed, accel}},
        .start_speed_steps_per_s = start_speed,
        .sections = 1,
    };
}

static inline struct motion_order order_endless(uint32_t start_speed, uint32_t speed, uint32_t accel)
{
    return (struct motion_order){
        .section = {motion_order_endless(speed, accel)},
        .start_speed_steps_per_s = start_speed,
        .sections = 1,
    };
}

static inline void begin(struct motion_order order)
{
    motion_plan_begin(&plan, &order, PLAN_START);
}

static inline void begin_two(uint32_t start_speed, struct motion_section first, struct motion_section second)
{
    begin((struct motion_order){
        .section = {first, second},
        .start_speed_steps_per_s = start_speed,
        .sections = 2,
    });
}

static inline struct motion_point point_at(uint64_t step, uint64_t speed2)
{
    return (struct motion_point){.time = {.ticks = PLAN_REPLACED}, .step = step, .speed2 = speed2};
}

static inline bool stop_at(uint64_t step, uint64_t speed2)
{
    const struct motion_point at = point_at(step, speed2);
    return motion_plan_stop(&plan, &at);
}

static inline bool change_at(uint64_t step, uint64_t speed2, uint32_t speed)
{
    const struct motion_point at = point_at(step, speed2);
    return motion_plan_change_speed(&plan, &at, speed);
}

/* Takes all segments; returns the pulses on them. */
static inline uint64_t take_segments(void)
{
    uint64_t pulses = 0;
    for (count = 0; count < SEGMENTS_MAX && motion_plan_next(&plan, &segments[count]); count++) {
        pulses += segments[count].steps;
    }
    return pulses;
}

/* Segments by their pulses, and whether the speed rises (+1), stays (0) or falls (-1) on them. */
static inline void assert_segment(unsigned index, uint32_t steps, int sign)
{
    TEST_ASSERT_LESS_THAN_UINT_MESSAGE(count, index, "no such segment");
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(steps, segments[index].steps, "steps");
    int32_t accel = segments[index].accel;
    TEST_ASSERT_EQUAL_INT_MESSAGE(sign, accel > 0 ? 1 : accel < 0 ? -1 : 0, "sign of the acceleration");
}

#endif
