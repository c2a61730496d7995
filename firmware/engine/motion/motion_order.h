/*
 * A move as a program orders it. A single move is one section, a compound move up to ten; a run
 * without end is one section that motion_order_endless makes.
 */
#ifndef MOTION_ORDER_H
#define MOTION_ORDER_H

#include <stdbool.h>
#include <stdint.h>

/* What the planner of one motor is proved for; the language stays far below. */
#define MOTION_SPEED_MAX UINT32_C(400000)

enum {
    MOTION_SECTIONS = 10
};

/* The longest section with an end: a hundred times the distance between the ends of the counter
 * that `=` can set. */
#define MOTION_SECTION_STEPS_MAX (UINT64_C(1) << 40)

/* The longest move with an end. */
#define MOTION_STEPS_MAX ((uint64_t)MOTION_SECTIONS * MOTION_SECTION_STEPS_MAX)

/* A ramp is handed over as one segment, which counts in 32 bits: the steps of one, up to speed^2 /
 * 2*accel, are fewer than 2^32. At 92 681 steps/s and below they are with any acceleration. */
struct motion_section {
    uint64_t steps;              /* 1 to MOTION_SECTION_STEPS_MAX, if the run is not endless */
    uint32_t speed_steps_per_s;  /* 1 to MOTION_SPEED_MAX: never exceeded */
    uint32_t accel_steps_per_s2; /* 1 to STEP_ACCEL_MAX */
};

struct motion_order {
    struct motion_section section[MOTION_SECTIONS];
    uint32_t start_speed_steps_per_s; /* start/stop speed S, 1 to MOTION_SPEED_MAX */
    uint8_t sections;                 /* 1 to MOTION_SECTIONS */
};

/* The section of a run without end, the only one of its order. */
struct motion_section motion_order_endless(uint32_t speed_steps_per_s, uint32_t accel_steps_per_s2);

/* Whether an order runs without end. */
bool motion_order_is_endless(const struct motion_order *order);

#endif
