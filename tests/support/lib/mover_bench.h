/*
 * The mover's bench: one mover on the host machine, with inputs that change once, and what it does on record.
 *
 * The machine starts at a random epoch. Ticks count from its start.
 */
#ifndef MOVER_BENCH_H
#define MOVER_BENCH_H

#include "host_machine.h"
#include "mover.h"

enum {
    MOVER_BENCH_MOTOR = 3,
    MOVER_BENCH_EVENTS_MAX = 16
};

struct mover_bench_event {
    enum hal_trace_event event;
    int64_t value;
};

struct mover_bench {
    struct host_machine machine;
    struct mover mover;
    struct mover_bench_event events[MOVER_BENCH_EVENTS_MAX];
    unsigned event_count;
    unsigned stops_sensed; /* how often mover_sense_isr said that it stopped the move */
    uint64_t last_edge_tick;
    unsigned edges; /* pulses at the pin */
    struct host_input input;
};

/* S100 V1000 A2000, 5000 steps: the ramps have 247.5 steps and last 0.45 s. */
extern const struct motion_order mover_bench_trapezoid;

/* Pulse k at k * 10 ms, 100 steps. */
extern const struct motion_order mover_bench_slow;

void mover_bench_init(struct mover_bench *bench);

/* Starts a move at the bench's time 0, forward. */
void mover_bench_start(struct mover_bench *bench, const struct motion_order *order, struct mover_guards guards,
                       uint8_t inputs);

/* The inputs from now on: `levels`, and `ms` milliseconds after the start `changed` the other way round. */
void mover_bench_set_inputs(struct mover_bench *bench, uint8_t levels, uint8_t changed, uint64_t ms);

/* Runs what happens before a tick; time stands there then. */
void mover_bench_run_until(struct mover_bench *bench, uint64_t tick);

/* Runs until nothing is left to happen; the mover must stand then. */
void mover_bench_run(struct mover_bench *bench);

/* So many steps have been made, negative ones backward, since the bench was set up. */
void mover_bench_assert_steps(const struct mover_bench *bench, int64_t steps);

/* Nothing but this one event has happened. */
void mover_bench_assert_only_event(const struct mover_bench *bench, enum hal_trace_event event, int64_t value);

/* This is why the move ended, and nothing but that stop has happened; NONE: nothing at all. */
void mover_bench_assert_cause(const struct mover_bench *bench, enum hal_trace_stop cause);

/* What must be at the end of every test: no late pulse, and all pulses counted. */
void mover_bench_check(const struct mover_bench *bench);

#endif
