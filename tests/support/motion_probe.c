/*
 * Moves of one motor, pulse by pulse: what the accuracy figures and the tests against the exact reference are made of.
 *
 * Comes in on standard input: cases of whole numbers, one case a line,
 *
 *     epoch  S  m {steps V A}*m  c {pulse V'}*c  w {pulse}*w
 *
 * with the unit's time at the start, the start/stop speed, m sections (steps 0: a run without end), c changes that take
 * effect at a pulse, in rising order (a new speed, or 0 for a stop), and the ordinals of the w pulses that are wanted,
 * rising (none: all).
 * Goes out, a line a case: the ticks of these pulses from the start of the move | the number of pulses made | pulses
 * that were late | the break points `step:speed` of the move as it is after the last change.
 * Exit status 2: the input is no such thing.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "hal_run.h"
#include "hal_step.h"
#include "host_machine.h"
#include "axis.h"

enum {
    CHANGES_MAX = 64,
    WANTED_MAX = 65536
};

struct change {
    uint64_t pulse;
    uint32_t speed_steps_per_s; /* 0: stop */
};

struct probe {
    struct host_machine machine;
    struct axis axis;
    struct motion_order order;
    uint64_t epoch;
    struct change changes[CHANGES_MAX];
    unsigned change_count;
    unsigned changes_made;
    uint64_t wanted[WANTED_MAX];
    unsigned wanted_count;
    unsigned wanted_told;
    struct motion_corner corners[MOTION_CORNERS_MAX];
    unsigned corner_count;
};

static uint64_t read_number(uint64_t max)
{
    uint64_t number;
    if (scanf("%" SCNu64, &number) != 1 || number > max) {
        (void)fprintf(stderr, "motion-probe: a number up to %" PRIu64 " is missing\n", max);
        exit(2);
    }
    return number;
}

static void read_order(struct motion_order *order)
{
    *order = (struct motion_order){.start_speed_steps_per_s = (uint32_t)read_number(UINT32_MAX)};
    order->sections = (uint8_t)read_number(MOTION_SECTIONS);
    for (unsigned i = 0; i < order->sections; i++) {
        uint64_t steps = read_number(MOTION_SECTION_STEPS_MAX);
        uint32_t speed = (uint32_t)read_number(UINT32_MAX);
        uint32_t accel = (uint32_t)read_number(UINT32_MAX);
        order->section[i] =
            steps != 0 ? (struct motion_section){steps, speed, accel} : motion_order_endless(speed, accel);
    }
}

/* False at the end of the input. */
static bool read_case(struct probe *probe)
{
    if (scanf(" ") == EOF || feof(stdin)) {
        return false;
    }
    probe->epoch = read_number(UINT64_MAX);
    read_order(&probe->order);
    probe->change_count = (unsigned)read_number(CHANGES_MAX);
    for (unsigned i = 0; i < probe->change_count; i++) {
        probe->changes[i].pulse = read_number(UINT64_MAX);
        probe->changes[i].speed_steps_per_s = (uint32_t)read_number(UINT32_MAX);
    }
    probe->wanted_count = (unsigned)read_number(WANTED_MAX);
    for (unsigned i = 0; i < probe->wanted_count; i++) {
        probe->wanted[i] = read_number(UINT64_MAX);
    }
    return true;
}

/* Whether the next change takes effect at the next pulse. */
static bool change_is_due(const struct probe *probe)
{
    return probe->changes_made < probe->change_count &&
           probe->changes[probe->changes_made].pulse == axis_steps_made(&probe->axis) + 1U;
}

static void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    struct probe *probe = context;
    (void)motor;
    (void)backward;
    if (probe->wanted_count != 0) {
        if (probe->wanted_told == probe->wanted_count || probe->machine.pulses != probe->wanted[probe->wanted_told]) {
            return;
        }
        probe->wanted_told++;
    }
    (void)printf("%" PRIu64 " ", tick);
}

/* Main, which lays pulses in a hold, looks for itself. */
static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    struct probe *probe = context;
    (void)motor;
    room->main_has_work = !probe->machine.step_held && change_is_due(probe);
    return axis_lay_isr(&probe->axis, room);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
}

static void plan_isr(void *context)
{
    (void)context;
}

static uint64_t main_pass(void *context)
{
    struct probe *probe = context;
    while (change_is_due(probe)) {
        const struct change *change = &probe->changes[probe->changes_made++];
        if (change->speed_steps_per_s != 0) {
            axis_change_speed(&probe->axis, change->speed_steps_per_s);
        } else {
            axis_stop(&probe->axis, AXIS_CAUSE_PAUSE);
        }
        probe->corner_count = axis_corners(&probe->axis, probe->corners);
    }
    axis_poll(&probe->axis);
    while (axis_feed(&probe->axis)) {
    }
    return UINT64_MAX;
}

static bool has_ended(void *context)
{
    const struct probe *probe = context;
    return !axis_is_moving(&probe->axis);
}

static void run_case(struct probe *probe)
{
    static const struct axis_guards none = {0};
    const struct hal_client client = {.context = probe, .lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    host_machine_init(&probe->machine, probe->epoch);
    probe->machine.listener = (struct host_listener){.context = probe, .step = step_seen};
    host_machine_select(&probe->machine);
    hal_run_start(&client);
    probe->changes_made = 0;
    probe->wanted_told = 0;
    axis_init(&probe->axis, 0);
    axis_begin(&probe->axis, &probe->order, false, probe->epoch, &none);
    probe->corner_count = axis_corners(&probe->axis, probe->corners);
    host_machine_run(&probe->machine, UINT64_MAX, main_pass, has_ended, probe);
}

static void tell_rest(const struct probe *probe)
{
    (void)printf("| %" PRIu64 " | %" PRIu64 " |", axis_steps_made(&probe->axis), probe->machine.late_steps);
    for (unsigned i = 0; i < probe->corner_count; i++) {
        (void)printf(" %" PRIu64 ":%" PRIu32, probe->corners[i].step, probe->corners[i].speed_steps_per_s);
    }
    (void)printf("\n");
}

int main(void)
{
    static struct probe probe;
    while (read_case(&probe)) {
        run_case(&probe);
        tell_rest(&probe);
    }
    return 0;
}
