/*
 * The test bench: a whole unit on the host machine, with everything that it does on record.
 *
 * bench_init begins at a random epoch, so that no test relies on where the counter stands; RKM04_SEED repeats a run.
 * All ticks count from the start of the machine, motors from 1 as in messages. The judge (judge.h) sees everything
 * that happens, each move with its order; bench_check, called in tearDown, tells what it complains of. A build
 * whose program memory is too small for the programs of these tests passes them over.
 */
#ifndef BENCH_H
#define BENCH_H

#include <stdbool.h>
#include <stdint.h>

#include "base_tick.h"
#include "hal_trace.h"
#include "host_machine.h"
#include "judge_unit.h"
#include "rkm04.h"

enum {
    BENCH_PULSES_MAX = 200000,
    BENCH_EVENTS_MAX = 8192,
    BENCH_EDGES_MAX = 1024,
    BENCH_INPUTS_MAX = 256,
    BENCH_TEXT_BYTES_MAX = MESSAGES_REQUEST_BYTES_MAX - 2,
};

struct bench_pulse {
    uint64_t tick;
    uint8_t motor;
    bool backward;
};

struct bench_event {
    uint64_t tick;
    int64_t value;
    uint8_t motor;
    enum hal_trace_event event;
};

/* An LED or the outputs: `value` is on/off, or all levels; motor 0 is the outputs. */
struct bench_edge {
    uint64_t tick;
    uint8_t motor;
    uint8_t value;
};

struct bench {
    struct judged_unit judged;
    struct host_machine machine;
    struct rkm04 unit;
    struct bench_pulse pulses[BENCH_PULSES_MAX];
    uint32_t pulse_count;
    uint32_t made[UNIT_MOTORS + 1]; /* pulses of each motor */
    struct bench_event events[BENCH_EVENTS_MAX];
    uint32_t event_count;
    bool forgets_events; /* they are for the judge alone, as there are too many */
    struct bench_edge edges[BENCH_EDGES_MAX];
    uint32_t edge_count;
    struct host_input script[BENCH_INPUTS_MAX];
    uint8_t answer[MESSAGES_ANSWER_BYTES_MAX + 1]; /* and the end of a string */
    uint32_t answer_length;
    struct judge judge;

    /* What bench_run_pulses waits for; main is called then, whatever the unit says. */
    unsigned wanted_motor;
    uint32_t wanted_pulses;
};

/* A unit that has just been switched on, at a random epoch or at a given one. */
void bench_init(struct bench *bench);
void bench_init_at(struct bench *bench, uint64_t epoch);

/* Switches the unit off and on again; what is recorded and what is stored stays. */
void bench_restart(struct bench *bench);

/* The same by its watchdog. */
void bench_restart_badly(struct bench *bench);

/* Sends program text to a motor (0 to 4) and returns the flag of the answer. */
uint8_t bench_send(struct bench *bench, unsigned motor, const char *text);

/* Sends any message; the answer is in `answer`. */
void bench_message(struct bench *bench, const void *request, uint32_t length);

/* The text of a request and its answer, without the first two bytes, as a string. */
const char *bench_ask(struct bench *bench, uint8_t number, unsigned motor);

/* The flash image of a text that is stored, to damage it; null if there is none. */
uint8_t *bench_find_in_flash(struct bench *bench, const char *text);

/* Runs for a time, until nothing happens any more (fails after a minute), or until a motor has made so many pulses. */
void bench_run_ms(struct bench *bench, uint32_t milliseconds);
void bench_run_ticks(struct bench *bench, uint64_t ticks);
void bench_run_idle(struct bench *bench);
void bench_run_pulses(struct bench *bench, unsigned motor, uint32_t pulses);

/* Sends a text and runs until nothing happens any more. */
void bench_do(struct bench *bench, unsigned motor, const char *text);

/* Sets an input (1 to 8) now, or at a tick that is later than those given before. */
void bench_set_input(struct bench *bench, uint8_t input, bool level);
void bench_plan_input(struct bench *bench, uint64_t tick, uint8_t input, bool level);

/* What has happened. Pulses count from 1, events from 0; what there is not fails the test. */
uint64_t bench_now(const struct bench *bench);
uint32_t bench_pulses(const struct bench *bench, unsigned motor);
uint64_t bench_pulse_tick(const struct bench *bench, unsigned motor, uint32_t pulse);
uint32_t bench_count(const struct bench *bench, unsigned motor, enum hal_trace_event event);
const struct bench_event *bench_event(const struct bench *bench, unsigned motor, enum hal_trace_event event,
                                      uint32_t which);
int64_t bench_position(const struct bench *bench, unsigned motor);
enum interpreter_state bench_state(const struct bench *bench, unsigned motor);
bool bench_output(const struct bench *bench, unsigned output);
uint64_t bench_led_tick(const struct bench *bench, unsigned motor, uint32_t edge);

/* What must hold after every test. */
void bench_check(struct bench *bench);

#endif
