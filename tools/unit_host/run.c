#include "run.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "units.h"

enum {
    PASSES_PER_LOOK = 256,
    STEPS_PER_LOOK = 4096,
    NS_PER_MILLI_RATIO = 1000,
    SECONDS_PER_LOOK = 10
};

static void record(struct run *run, const struct timeline_event *event)
{
    if (run->recorder.active) {
        recorder_put(&run->recorder, event, run->machine.now);
    }
}

static void tell_progress(struct run *run, uint64_t real_ns, uint64_t tick)
{
    if (run->progress_ns != 0 && real_ns - run->told_ns >= run->progress_ns) {
        run->told_ns = real_ns;
        (void)fprintf(stderr, "progress %" PRIu64 "\n", tick / TICKS_PER_MS);
    }
}

/* What else changes a position does so in main, see take_positions. */
static void hear_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    struct run *run = context;
    int64_t position = run->positions[motor] + (backward ? -1 : 1);
    run->positions[motor] = position;
    if (run->progress_ns != 0 && ++run->steps % STEPS_PER_LOOK == 0) {
        tell_progress(run, units_real_ns(), tick); /* a long run makes many pulses in few passes */
    }
    uint64_t interval_ticks = tally_count_pulse(&run->tally[motor], tick, position);
    record(run, &(struct timeline_event){.tick = tick,
                                         .kind = TIMELINE_STEP,
                                         .motor = (uint8_t)(motor + 1U),
                                         .value = position,
                                         .interval_ticks = interval_ticks});
}

static void hear_direction(void *context, uint64_t tick, unsigned motor, bool backward)
{
    record(context, &(struct timeline_event){
                        .tick = tick, .kind = TIMELINE_DIRECTION, .motor = (uint8_t)(motor + 1U), .value = backward});
}

static void hear_polarity(void *context, uint64_t tick, unsigned motor, bool falling, bool turned)
{
    record(context, &(struct timeline_event){.tick = tick,
                                             .kind = TIMELINE_POLARITY,
                                             .motor = (uint8_t)(motor + 1U),
                                             .detail = falling,
                                             .value = turned});
}

static void hear_led(void *context, uint64_t tick, unsigned led, bool on)
{
    record(context,
           &(struct timeline_event){.tick = tick, .kind = TIMELINE_LED, .motor = (uint8_t)(led + 1U), .value = on});
}

static void hear_pwm(void *context, uint64_t tick, uint32_t permille)
{
    record(context, &(struct timeline_event){.tick = tick, .kind = TIMELINE_PWM, .value = permille});
}

static void hear_input(void *context, uint64_t tick, uint8_t levels)
{
    struct run *run = context;
    unsigned shown = (unsigned)levels ^ run->kind->inputs_turned;
    record(run, &(struct timeline_event){.tick = tick, .kind = TIMELINE_INPUT, .value = shown});
}

static void hear_output(void *context, uint64_t tick, uint8_t levels)
{
    record(context, &(struct timeline_event){.tick = tick, .kind = TIMELINE_OUTPUT, .value = levels});
}

/* A position that a command has written; those that pulses make are recorded with the pulses. */
static void record_position(struct run *run, unsigned motor, uint64_t tick)
{
    int64_t position = run->kind->position_steps(run->unit, motor - 1U);
    if (position != run->positions[motor - 1U]) {
        run->positions[motor - 1U] = position;
        record(run, &(struct timeline_event){
                        .tick = tick, .kind = TIMELINE_POSITION, .motor = (uint8_t)motor, .value = position});
    }
}

/* Not among the events of the files: a program that never waits runs more commands than there is room for. */
static void record_command(struct run *run, unsigned motor, uint64_t tick, int64_t ordinal)
{
    if (run->recorder.active) {
        recorder_put_command(&run->recorder, tick, motor, ordinal);
    }
}

static void hear_trace(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    struct run *run = context;
    if (event == HAL_TRACE_MOVE && motor != 0) {
        record_position(run, motor, tick);
        tally_begin_move(&run->tally[motor - 1U], tick, run->kind->position_steps(run->unit, motor - 1U));
    } else if (event == HAL_TRACE_DONE && motor != 0) {
        tally_end_move(&run->tally[motor - 1U], tick, run->kind->moves_together);
    }
    if (event == HAL_TRACE_COMMAND) {
        record_command(run, motor, tick, value);
        return;
    }
    record(
        run,
        &(struct timeline_event){
            .tick = tick, .kind = TIMELINE_TRACE, .motor = (uint8_t)motor, .detail = (uint8_t)event, .value = value});
}

/* To ask the unit at each pulse would take longer than the pulse. */
static void take_positions(struct run *run)
{
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        if (run->kind->is_moving(run->unit, motor - 1U)) {
            run->positions[motor - 1U] = run->kind->position_steps(run->unit, motor - 1U);
        } else {
            record_position(run, motor, run->machine.now);
        }
    }
}

static void hear_line(void *context, uint64_t tick, uint8_t value)
{
    struct run *run = context;
    if (run->partner.line != NULL) {
        run->partner.line(run->partner.context, tick, value);
    }
}

static uint64_t run_pass(void *context)
{
    struct run *run = context;
    uint64_t wake = run->kind->poll(run->unit);
    take_positions(run);
    uint64_t next = run->partner.pass != NULL ? run->partner.pass(run->partner.context) : TICK_NEVER;
    uint64_t wanted = next == TICK_NEVER ? next : run->machine.epoch + next;
    return wanted < wake ? wanted : wake;
}

static void look_at_limit(struct run *run, uint64_t real_ns)
{
    run->cut = run->limit_ns != 0 && real_ns - run->begin_ns > run->limit_ns;
}

/* The clock is asked now and then only, as asking takes longer than a pass. */
static bool run_is_over(void *context)
{
    struct run *run = context;
    run->idle =
        run->kind->is_idle(run->unit) && (run->partner.is_over == NULL || run->partner.is_over(run->partner.context));
    if (++run->passes % PASSES_PER_LOOK == 0 && (run->limit_ns != 0 || run->progress_ns != 0)) {
        uint64_t real_ns = units_real_ns();
        look_at_limit(run, real_ns);
        tell_progress(run, real_ns, run->machine.now);
    }
    return run->idle || run->cut;
}

void run_init(struct run *run, const struct unit_kind *kind, void *unit, uint64_t epoch)
{
    run->kind = kind;
    run->unit = unit;
    run->partner = (struct run_partner){.context = NULL};
    host_machine_init(&run->machine, epoch);
    host_machine_select(&run->machine);
    run->machine.listener = (struct host_listener){
        .context = run,
        .step = hear_step,
        .direction = hear_direction,
        .polarity = hear_polarity,
        .pwm = hear_pwm,
        .led = hear_led,
        .input = hear_input,
        .output = hear_output,
        .trace = hear_trace,
        .line = hear_line,
    };
    run->recorder.active = false;
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        run->tally[i] = (struct tally){.moves = 0};
        run->positions[i] = 0;
    }
    run->progress_ns = 0;
    run->steps = 0;
    run->limit_ns = 0;
    run->passes = 0;
    run->real_ns = 0;
    run->idle = false;
    run->cut = false;
}

void run_begin(struct run *run)
{
    run->kind->begin(run->unit);
}

/* In a long move there are no passes: with a limit the clock is asked between parts of the time, too. */
void run_until(struct run *run, uint64_t until_tick)
{
    const uint64_t part = (uint64_t)SECONDS_PER_LOOK * TICK_HZ;
    run->begin_ns = units_real_ns();
    run->told_ns = run->begin_ns;
    do {
        bool is_last = run->limit_ns == 0 || until_tick - run->machine.now <= part;
        host_machine_run(&run->machine, is_last ? until_tick : run->machine.now + part, run_pass, run_is_over, run);
        look_at_limit(run, units_real_ns());
    } while (!run->idle && !run->cut && run->machine.now < until_tick);
    run->real_ns += units_real_ns() - run->begin_ns;
}

const char *run_end_text(const struct run *run)
{
    if (run->idle) {
        return "idle";
    }
    return run->cut ? "real" : "time";
}

uint64_t run_milli_ratio(const struct run *run)
{
    uint64_t real_us = run->real_ns / NS_PER_MILLI_RATIO;
    return units_ns_of_ticks(run->machine.now) / (real_us == 0 ? 1U : real_us);
}
