/*
 * What the images with the real step driver and another main share: four step channels as its client.
 */
#ifndef DRIVER_H
#define DRIVER_H

#include "base_limits.h"
#include "hal_run.h"
#include "step_channel.h"

static struct step_channel channels[UNIT_MOTORS];

static unsigned driver_lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    return step_channel_lay_isr(&channels[motor], room);
}

static void driver_tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
}

static void driver_plan_isr(void *context)
{
    (void)context;
}

static inline void driver_start(void)
{
    static const struct hal_client client = {
        .lay_isr = driver_lay_isr, .tick_isr = driver_tick_isr, .plan_isr = driver_plan_isr};
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        step_channel_init(&channels[motor], motor);
    }
    hal_run_start(&client);
}

#endif
