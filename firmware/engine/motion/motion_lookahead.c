#include "motion_plan_private.h"

/* No speed at a border is higher than both its sections allow, nor the last than S. */
static uint64_t border_cap(const struct motion_order *order, unsigned section)
{
    uint32_t after = section + 1U < order->sections ? order->section[section + 1U].speed_steps_per_s
                                                    : order->start_speed_steps_per_s;
    return motion_lower(motion_square(order->section[section].speed_steps_per_s), motion_square(after));
}

uint64_t motion_lookahead_brakeable(const struct motion_plan *plan, unsigned section)
{
    const struct motion_section *order = &plan->order.section[section];
    return plan->exit_speed2[section] + motion_gain(order->accel_steps_per_s2, order->steps);
}

void motion_lookahead_backward(struct motion_plan *plan)
{
    unsigned last = plan->order.sections - 1U;
    plan->exit_speed2[last] = border_cap(&plan->order, last);
    for (unsigned i = last; i > plan->first; i--) {
        plan->exit_speed2[i - 1U] = motion_lower(border_cap(&plan->order, i - 1U), motion_lookahead_brakeable(plan, i));
    }
}

/* After a change of speed the motor may be too fast for the next border even if it brakes all the
 * way. Then the border gets the speed that the brake can reach; the plan before the change has
 * proved it slow enough for all that follows. */
void motion_lookahead_forward(struct motion_plan *plan)
{
    uint64_t speed2 = plan->origin.speed2;
    for (unsigned i = plan->first; i < plan->order.sections; i++) {
        struct motion_span span = motion_plan_section_span(plan, i, speed2);
        uint64_t enter = motion_profile_enter(&span);
        uint64_t gain = motion_gain(span.accel_steps_per_s2, span.steps);
        uint64_t exit = motion_lower(plan->exit_speed2[i], enter + gain);
        bool too_fast = enter > gain && enter - gain > motion_profile_floor(&span);
        speed2 = too_fast ? enter - gain : exit;
        plan->exit_speed2[i] = speed2;
    }
}
