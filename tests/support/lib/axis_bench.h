/*
 * The bench of an axis: one axis on the host machine, with inputs that change once, and what it does on record.
 *
 * The machine starts at a random epoch. Ticks count from its start.
 */
#ifndef AXIS_BENCH_H
#define AXIS_BENCH_H

#include "host_machine.h"
#include "axis.h"

enum {
    AXIS_BENCH_MOTOR = 3,
    AXIS_BENCH_EVENTS_MAX = 16
};

struct axis_bench_event {
    enum hal_trace_event event;
    int64_t value;
    uint64_t tick;
};

struct axis_bench {
    struct host_machine machine;
    struct axis axis;
    struct axis_bench_event events[AXIS_BENCH_EVENTS_MAX]; /* all but the beginning and end of each motion */
    unsigned event_count;
    struct axis_bench_event motions[AXIS_BENCH_EVENTS_MAX]; /* the beginning and end of each, the youngest ones */
    unsigned motion_count;
    unsigned stops_sensed; /* how often axis_sense_isr said that it stopped the move */
    uint64_t last_edge_tick;
    unsigned edges; /* pulses at the pin */
    struct host_input input;
};

/* S100 V1000 A2000, 5000 steps: the ramps have 247.5 steps and last 0.45 s. */
extern const struct motion_order axis_bench_trapezoid;

/* Pulse k at k * 10 ms, 100 steps. */
extern const struct motion_order axis_bench_slow;

void axis_bench_init(struct axis_bench *bench);

/* Starts a move at the bench's time 0, forward. */
void axis_bench_start(struct axis_bench *bench, const struct motion_order *order, struct axis_guards guards,
                      uint8_t inputs);

/* The inputs from now on: `levels`, and `ms` milliseconds after the start `changed` the other way round. */
void axis_bench_set_inputs(struct axis_bench *bench, uint8_t levels, uint8_t changed, uint64_t ms);

/* Runs what happens before a tick; time stands there then. */
void axis_bench_run_until(struct axis_bench *bench, uint64_t tick);

/* Runs until nothing is left to happen; the axis must stand then. */
void axis_bench_run(struct axis_bench *bench);

/* So many steps have been made, negative ones backward, since the bench was set up. */
void axis_bench_assert_steps(const struct axis_bench *bench, int64_t steps);

/* Nothing but this one event has happened. */
void axis_bench_assert_only_event(const struct axis_bench *bench, enum hal_trace_event event, int64_t value);

/* This is why the move ended, and nothing but that stop has happened; NONE: nothing at all. */
void axis_bench_assert_cause(const struct axis_bench *bench, enum axis_cause cause);

/* The youngest beginning or end of a motion was this one. */
void axis_bench_assert_motion(const struct axis_bench *bench, enum hal_trace_event event, int64_t steps, uint64_t tick);

/* What must be at the end of every test: no late pulse, and all pulses counted. */
void axis_bench_check(const struct axis_bench *bench);

#endif
