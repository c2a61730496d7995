#include "motion_order.h"

#include "motion_endless.h"

struct motion_section motion_order_endless(uint32_t speed_steps_per_s, uint32_t accel_steps_per_s2)
{
    return (struct motion_section){
        .steps = MOTION_ENDLESS_STEPS,
        .speed_steps_per_s = speed_steps_per_s,
        .accel_steps_per_s2 = accel_steps_per_s2,
    };
}

bool motion_order_is_endless(const struct motion_order *order)
{
    return order->section[0].steps == MOTION_ENDLESS_STEPS;
}
