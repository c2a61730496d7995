/*
 * The step path compiled for Cortex-M4, as arm_count.py calls it function by function: one motor's channel, fed from
 * one move, with a step output that only remembers the armed tick.
 */
#include <stdbool.h>
#include <stdint.h>

#include "hal_step.h"
#include "motion_plan.h"
#include "step_channel.h"

static struct step_channel channel;
static struct motion_plan plan;
static uint32_t armed_tick;

void bench_begin(uint32_t start_speed, uint32_t speed, uint32_t accel, uint32_t steps);
bool bench_feed(void);
void bench_run(void);
uint32_t bench_next(void);
bool bench_pulse(void);
uint32_t bench_armed(void);

void hal_step_arm(unsigned motor, uint32_t tick)
{
    (void)motor;
    armed_tick = tick;
}

bool hal_step_disarm(unsigned motor)
{
    (void)motor;
    return true;
}

void hal_step_set_direction(unsigned motor, bool backward)
{
    (void)motor;
    (void)backward;
}

void hal_step_hold(void)
{
}

void hal_step_release(void)
{
}

/* A function of its own, to be counted. */
__attribute__((noinline)) static uint32_t find_next(struct step_generator *generator)
{
    return step_generator_next(generator);
}

/* Plans a single move at tick 0. */
void bench_begin(uint32_t start_speed, uint32_t speed, uint32_t accel, uint32_t steps)
{
    struct motion_order order = {
        .section = {{.steps = steps, .speed_steps_per_s = speed, .accel_steps_per_s2 = accel}},
        .start_speed_steps_per_s = start_speed,
        .sections = 1,
    };
    step_channel_init(&channel, 0);
    step_channel_begin(&channel, 0, false);
    motion_plan_begin(&plan, &order, 0);
}

/* Lays one segment; false when there is none left. */
bool bench_feed(void)
{
    struct step_segment segment;
    bool more = motion_plan_next(&plan, &segment);
    if (more) {
        step_channel_push(&channel, &segment);
    }
    return more;
}

void bench_run(void)
{
    step_channel_run(&channel);
}

/* The next tick alone, found as the channel will find it; 0 where a segment ends. */
uint32_t bench_next(void)
{
    struct step_generator generator = channel.cursor.generator;
    return channel.cursor.left == 0 ? 0 : find_next(&generator);
}

/* The work of one step interrupt; false after the last pulse. */
bool bench_pulse(void)
{
    (void)step_channel_pulse_isr(&channel);
    return step_channel_is_running(&channel);
}

uint32_t bench_armed(void)
{
    return armed_tick;
}
