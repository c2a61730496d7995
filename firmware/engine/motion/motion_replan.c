#include "motion_plan_private.h"
#include "step_scale.h"

/* The section that begins or goes on after a step; order.sections if the move ends there. */
static unsigned section_after(const struct motion_plan *plan, uint64_t step)
{
    unsigned section = 0;
    uint64_t end = 0;
    for (; section < plan->order.sections; section++) {
        end += plan->order.section[section].steps;
        if (step < end) {
            break;
        }
    }
    return section;
}

bool motion_plan_brake(const struct motion_plan *plan, uint64_t step, uint64_t slope, struct motion_brake *brake)
{
    unsigned section = section_after(plan, step);
    if (section == plan->order.sections) {
        return false;
    }
    const struct motion_section *order = &plan->order.section[section];
    uint64_t speed2 = motion_square((uint32_t)(slope / STEP_SLOPE_PER_SPEED));
    uint64_t target = motion_square(plan->order.start_speed_steps_per_s);
    uint64_t half = speed2 > target ? (speed2 - target) / (4U * (uint64_t)order->accel_steps_per_s2) : 0;
    brake->accel = (int32_t)(order->accel_steps_per_s2 * STEP_ACCEL_PER_ACCEL);
    brake->until = motion_lower(step + half, motion_plan_section_begin(plan, section) + order->steps);
    return true;
}

/* Brakes through the sections, each with its own acceleration, until S is reached; the move ends
 * in that section. The last ramp of an order is planned the same way, so a stop on it changes
 * nothing. */
static void plan_brake(struct motion_plan *plan)
{
    uint64_t target = motion_square(plan->order.start_speed_steps_per_s);
    uint64_t speed2 = plan->origin.speed2;
    unsigned section = plan->first;
    while (speed2 > target) {
        struct motion_span span = motion_plan_section_span(plan, section, speed2);
        uint64_t gain = motion_gain(span.accel_steps_per_s2, span.steps);
        speed2 = speed2 > gain && speed2 - gain > target ? speed2 - gain : target;
        plan->exit_speed2[section] = speed2;
        section++;
    }
    plan->order.sections = (uint8_t)section;
}

bool motion_plan_stop(struct motion_plan *plan, const struct motion_point *at)
{
    unsigned section = section_after(plan, at->step);
    if (section == plan->order.sections) {
        return false;
    }
    plan->origin = *at;
    plan->first = (uint8_t)section;
    plan->kind = MOTION_PLAN_STOP;
    plan_brake(plan);
    motion_plan_rewind(plan);
    return true;
}

bool motion_plan_change_speed(struct motion_plan *plan, const struct motion_point *at, uint32_t speed_steps_per_s)
{
    unsigned section = section_after(plan, at->step);
    if (section == plan->order.sections) {
        return false;
    }
    plan->order.section[section].speed_steps_per_s = speed_steps_per_s;
    plan->origin = *at;
    plan->first = (uint8_t)section;
    plan->kind = MOTION_PLAN_CHANGED;
    motion_lookahead_backward(plan);
    motion_lookahead_forward(plan);
    motion_plan_rewind(plan);
    return true;
}
