/*
 * The rig of the tests of the GVE134 unit's queue: the queue on the host machine, what its pins show and what it tells
 * onlookers.
 *
 * To be included by one test program alone.
 */
#ifndef GVE_QUEUE_RIG_H
#define GVE_QUEUE_RIG_H

#include "gve_queue.h"
#include "unity.h"

#include "base_tick.h"
#include "epoch.h"
#include "hal_run.h"
#include "hal_trace.h"
#include "host_machine.h"

enum {
    RIG_AHEAD_TICKS = 512 * TICKS_PER_US,
    RIG_TOLD_MAX = 64,
};

/* An event of the trace. */
struct rig_told {
    uint64_t tick; /* from the start of the machine */
    unsigned motor;
    enum hal_trace_event event;
    int64_t value;
};

static struct host_machine machine;
static struct gve_queue queue;
static int64_t rig_position[UNIT_MOTORS];    /* at the pins */
static uint64_t rig_first_tick[UNIT_MOTORS]; /* of the first pulse since rig_forget_pulses; TICK_NEVER: none */
static uint64_t rig_last_tick[UNIT_MOTORS];  /* of the last pulse */
static struct rig_told rig_told[RIG_TOLD_MAX];
static unsigned rig_told_count;
static bool rig_main_is_busy; /* main makes no passes */

static inline unsigned rig_lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    return gve_queue_lay_isr(&queue, motor, room);
}

static inline void rig_tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
    if (gve_queue_sense_isr(&queue, machine.inputs)) {
        hal_run_plan();
    }
}

static inline void rig_plan_isr(void *context)
{
    (void)context;
    gve_queue_plan_isr(&queue);
}

static inline void rig_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    rig_position[motor] += backward ? -1 : 1;
    rig_first_tick[motor] = rig_first_tick[motor] == TICK_NEVER ? tick : rig_first_tick[motor];
    rig_last_tick[motor] = tick;
}

static inline void rig_trace(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    (void)context;
    TEST_ASSERT_LESS_THAN(RIG_TOLD_MAX, rig_told_count);
    rig_told[rig_told_count++] = (struct rig_told){.tick = tick, .motor = motor, .event = event, .value = value};
}

static inline uint64_t rig_poll(void *context)
{
    (void)context;
    return rig_main_is_busy ? TICK_NEVER : gve_queue_poll(&queue, machine.inputs);
}

static inline void rig_forget_pulses(void)
{
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        rig_first_tick[motor] = TICK_NEVER;
    }
}

static inline void rig_set_up(void)
{
    static const struct hal_client client = {
        .lay_isr = rig_lay_isr, .tick_isr = rig_tick_isr, .plan_isr = rig_plan_isr};
    host_machine_init(&machine, epoch_random());
    machine.ahead_ticks = RIG_AHEAD_TICKS;
    machine.listener = (struct host_listener){.step = rig_step, .trace = rig_trace};
    host_machine_select(&machine);
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        rig_position[motor] = 0;
        rig_last_tick[motor] = 0;
    }
    rig_forget_pulses();
    rig_told_count = 0;
    rig_main_is_busy = false;
    gve_queue_init(&queue);
    hal_run_start(&client);
}

static inline void rig_run_ms(uint64_t ms)
{
    host_machine_run(&machine, machine.now + ms * TICKS_PER_MS, rig_poll, NULL, NULL);
}

static inline void rig_run_to_the_end(void)
{
    for (unsigned i = 0; i < 10000 && gve_queue_moves(&queue); i++) {
        rig_run_ms(1);
    }
    TEST_ASSERT_FALSE(gve_queue_moves(&queue));
}

/* A vector of one axis. */
static inline void rig_enter(unsigned axis, int32_t way)
{
    int32_t steps[PATH_AXES] = {0};
    steps[axis] = way;
    gve_queue_enter(&queue, steps);
}

static inline void rig_move(unsigned axis, int32_t way)
{
    rig_enter(axis, way);
    gve_queue_begin(&queue, machine.inputs);
}

#endif
