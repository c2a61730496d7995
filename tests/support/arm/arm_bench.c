/*
 * The step path compiled for Cortex-M4, as arm_count.py calls it function by function: one motor's channel, fed from
 * one move, with a step output that only counts the pulses that are laid.
 */
#include <stdbool.h>
#include <stdint.h>

#include "hal_step.h"
#include "motion_plan.h"
#include "step_channel.h"

enum {
    PLACES = 64,
    HIGH_TICKS = 210
};

static struct step_channel channel;
static struct motion_plan plan;
static struct hal_step_pulse pulses[PLACES];
static uint32_t laid;

void bench_begin(uint32_t start_speed, uint32_t speed, uint32_t accel, uint32_t steps);
bool bench_feed(void);
void bench_run(void);
uint32_t bench_next(void);
uint32_t bench_lay(uint32_t count);

/* Asks for `count` pulses while as many wait of those laid before; of one at a time none does. */
static uint32_t lay(uint32_t count)
{
    uint32_t before = count > 1U ? count : 0;
    struct hal_step_room room = {
        .pulse = pulses,
        .count = count,
        .waiting = laid < before ? laid : before,
        .until_tick = channel.cursor.generator.tick + (UINT32_C(1) << 30U),
        .high_ticks = HIGH_TICKS,
    };
    uint32_t more = step_channel_lay_isr(&channel, &room);
    laid += more;
    return more;
}

void hal_step_run(unsigned motor)
{
    (void)motor;
    (void)lay(1);
}

unsigned hal_step_waiting(unsigned motor)
{
    (void)motor;
    return 0;
}

unsigned hal_step_take_back(unsigned motor, unsigned count)
{
    (void)motor;
    (void)count;
    return 0;
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
    laid = 0;
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

/* Has up to `count` pulses laid at once and tells how many; 0 after the last pulse. */
uint32_t bench_lay(uint32_t count)
{
    return lay(count);
}
