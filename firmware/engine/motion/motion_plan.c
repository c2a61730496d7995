#include "motion_plan_private.h"

uint64_t motion_plan_section_begin(const struct motion_plan *plan, unsigned section)
{
    uint64_t begin = 0;
    for (unsigned i = 0; i < section; i++) {
        begin += plan->order.section[i].steps;
    }
    return begin;
}

struct motion_span motion_plan_section_span(const struct motion_plan *plan, unsigned section, uint64_t enter_speed2)
{
    const struct motion_section *order = &plan->order.section[section];
    uint64_t begin = motion_plan_section_begin(plan, section);
    uint64_t skip = section == plan->first ? plan->origin.step - begin : 0;
    return (struct motion_span){
        .begin = begin + skip,
        .steps = order->steps - skip,
        .enter_speed2 = enter_speed2,
        .exit_speed2 = plan->exit_speed2[section],
        .speed_steps_per_s = order->speed_steps_per_s,
        .accel_steps_per_s2 = order->accel_steps_per_s2,
        .start_speed_steps_per_s = plan->order.start_speed_steps_per_s,
        .jumps = plan->kind == MOTION_PLAN_CHANGED && section == plan->first,
    };
}

void motion_plan_rewind(struct motion_plan *plan)
{
    plan->progress = (struct motion_progress){
        .time = plan->origin.time,
        .place = {.step = plan->origin.step},
        .section = plan->first,
    };
}

static void take_order(struct motion_plan *plan, const struct motion_order *order, uint64_t start_tick)
{
    uint64_t speed2 =
        motion_lower(motion_square(order->start_speed_steps_per_s), motion_square(order->section[0].speed_steps_per_s));
    *plan = (struct motion_plan){
        .order = *order,
        .origin = {.time = {.ticks = start_tick}, .speed2 = speed2},
    };
    plan->mark_step = motion_plan_section_begin(plan, plan->order.sections - 1U);
}

void motion_plan_begin(struct motion_plan *plan, const struct motion_order *order, uint64_t start_tick)
{
    take_order(plan, order, start_tick);
    motion_lookahead_backward(plan);
    plan->origin.speed2 = motion_lower(plan->origin.speed2, motion_lookahead_brakeable(plan, 0));
    plan->begin_speed2 = plan->origin.speed2;
    motion_lookahead_forward(plan);
    motion_plan_rewind(plan);
}
