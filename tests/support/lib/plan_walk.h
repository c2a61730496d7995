/*
 * A walk along the pulses of one plan, made as a channel makes them. To be included by one test program alone.
 */
#ifndef PLAN_WALK_H
#define PLAN_WALK_H

#include "base_tick.h"
#include "motion_plan.h"
#include "step_channel.h"

static struct motion_plan plan;
static struct step_cursor cursor;
static uint64_t now;

static inline void walk_begin(const struct motion_order *order, uint64_t start_tick)
{
    now = start_tick;
    cursor = (struct step_cursor){0};
    motion_plan_begin(&plan, order, start_tick);
    step_generator_start(&cursor.generator, (uint32_t)start_tick);
}

/* Moves on by a pulse; false after the last one. */
static inline bool walk_on(void)
{
    if (cursor.left == 0) {
        struct step_segment segment;
        if (!motion_plan_next(&plan, &segment)) {
            return false;
        }
        step_generator_load(&cursor.generator, &segment);
        cursor.left = segment.steps;
        cursor.end += segment.steps;
    } else {
        (void)step_generator_next(&cursor.generator);
    }
    cursor.left--;
    now = tick_extend(cursor.generator.tick, now);
    return true;
}

#endif
