#include "recorder.h"

#include "line.h"

#define TICK_HZ UINT64_C(84000000) /* of the unit, where its timer does not run */

enum {
    LINE_BYTES_MAX = 128
};

static uint64_t tick_hz(const struct recorder *recorder)
{
    bool started = recorder->wires.timer->start_cycle != VTIME_NEVER;
    return started ? recorder->wires.clock->time.hclk_hz / timer_tick_cycles(recorder->wires.timer) : TICK_HZ;
}

uint64_t recorder_tick(const struct recorder *recorder, uint64_t cycle)
{
    uint64_t start = recorder->wires.timer->start_cycle;
    if (start == VTIME_NEVER || cycle < start) {
        return vtime_scale(clock_ps_of_cycle(recorder->wires.clock, cycle), TICK_HZ, VTIME_PS_PER_SECOND);
    }
    uint64_t ticks = (cycle - start) / timer_tick_cycles(recorder->wires.timer);
    return ticks + (recorder->wires.ticks_from_timer ? 0
                                                     : vtime_scale(clock_ps_of_cycle(recorder->wires.clock, start),
                                                                   tick_hz(recorder), VTIME_PS_PER_SECOND));
}

bool recorder_open(struct recorder *recorder, const char *steps, const char *vcd)
{
    for (unsigned i = 0; i < SIGNALS; i++) {
        recorder->level[i] = recorder->wires.pins->low[i];
    }
    for (unsigned i = 0; i < PINS_MOTORS; i++) {
        recorder->motor[i] = (struct recorder_motor){.width_least_ps = VTIME_NEVER,
                                                     .gap_least_ps = VTIME_NEVER,
                                                     .period_least_ps = VTIME_NEVER,
                                                     .setup_least_ps = VTIME_NEVER,
                                                     .hold_least_ps = VTIME_NEVER};
    }
    recorder->first_step_ps = VTIME_NEVER;
    if (!outfile_open(&recorder->steps, steps) || !outfile_open(&recorder->waves.file, vcd)) {
        return false;
    }
    waves_begin(&recorder->waves, recorder->level);
    return true;
}

/* The table begins when the rate of the timer is known. */
static void begin_steps(struct recorder *recorder)
{
    uint64_t hz = tick_hz(recorder);
    if (recorder->tick_hz == hz) {
        return;
    }
    if (recorder->tick_hz != 0) {
        report_warn(recorder->wires.report,
                    "the step timer has changed its rate; the ticks of the table do not fit together");
        return;
    }
    recorder->tick_hz = hz;
    if (outfile_is_open(&recorder->steps)) {
        char *at = line_put_string(outfile_reserve(&recorder->steps, LINE_BYTES_MAX), "# tick_hz=");
        at = line_put_unsigned(at, hz);
        outfile_commit(&recorder->steps, line_put_string(at, "\ntick,motor,position\n"));
    }
}

static void write_step(struct recorder *recorder, unsigned motor, uint64_t cycle)
{
    begin_steps(recorder);
    if (outfile_is_open(&recorder->steps)) {
        char *at = line_put_unsigned(outfile_reserve(&recorder->steps, LINE_BYTES_MAX), recorder_tick(recorder, cycle));
        *at++ = ',';
        at = line_put_unsigned(at, motor + 1U);
        *at++ = ',';
        at = line_put_signed(at, recorder->motor[motor].position);
        *at++ = '\n';
        outfile_commit(&recorder->steps, at);
    }
}

/* The shortest time between two events, where there were both. */
static void note_time(struct recorder *recorder, uint64_t *least_ps, uint64_t from_cycle, uint64_t cycle)
{
    uint64_t ps = vtime_scale(cycle - from_cycle, VTIME_PS_PER_SECOND, recorder->wires.clock->time.hclk_hz);
    if (from_cycle >= recorder->wires.clock->time.anchor_cycle && ps < *least_ps) {
        *least_ps = ps;
    }
}

static void note_pulse(struct recorder *recorder, unsigned index, uint64_t cycle)
{
    struct recorder_motor *motor = &recorder->motor[index];
    motor->position += recorder->level[SIGNAL_DIRECTION + index] ? -1 : 1;
    if (recorder->first_step_ps == VTIME_NEVER) {
        recorder->first_step_ps = clock_ps_of_cycle(recorder->wires.clock, cycle);
    }
    if (motor->pulses > 0) {
        note_time(recorder, &motor->period_least_ps, motor->rise_cycle, cycle);
        note_time(recorder, &motor->gap_least_ps, motor->fall_cycle, cycle);
    }
    if (motor->direction_fresh) {
        note_time(recorder, &motor->setup_least_ps, motor->turn_cycle, cycle);
    }
    uint64_t interval = motor->pulses > 0 ? cycle - motor->rise_cycle : 0;
    motor->direction_fresh = false;
    motor->pulses++;
    motor->rise_cycle = cycle;
    write_step(recorder, index, cycle);
    waves_put_pulse(&recorder->waves, index, motor->position, recorder->wires.clock->time.hclk_hz, interval);
}

static void note_step_level(struct recorder *recorder, unsigned index, bool level, uint64_t cycle)
{
    struct recorder_motor *motor = &recorder->motor[index];
    if (level) {
        note_pulse(recorder, index, cycle);
        return;
    }
    motor->fall_cycle = cycle;
    if (motor->pulses > 0) {
        note_time(recorder, &motor->width_least_ps, motor->rise_cycle, cycle);
    }
}

static void note_direction(struct recorder *recorder, unsigned index, uint64_t cycle)
{
    struct recorder_motor *motor = &recorder->motor[index];
    if (motor->pulses > 0 && !motor->direction_fresh) {
        note_time(recorder, &motor->hold_least_ps, motor->rise_cycle, cycle);
    }
    motor->turn_cycle = cycle;
    motor->direction_fresh = true;
}

void recorder_note_edge(void *model, struct pin pin, bool level, uint64_t cycle)
{
    struct recorder *recorder = model;
    unsigned signal = recorder->wires.pins->signal[pin.port][pin.number];
    if (signal == SIGNAL_NONE) {
        return;
    }
    bool logical = level != recorder->wires.pins->low[signal];
    if (recorder->level[signal] == logical) {
        return;
    }
    recorder->level[signal] = logical;
    recorder->edge_cycle[signal] = cycle;
    if (outfile_is_open(&recorder->waves.file)) {
        waves_put_wire(&recorder->waves, signal, logical,
                       clock_ps_of_cycle(recorder->wires.clock, cycle) / VTIME_PS_PER_NS);
    }
    if (signal < SIGNAL_DIRECTION) {
        note_step_level(recorder, signal - SIGNAL_STEP, logical, cycle);
    } else if (signal < SIGNAL_LED) {
        note_direction(recorder, signal - SIGNAL_DIRECTION, cycle);
    } else if (signal == SIGNAL_DRIVER) {
        rs485_note_driver(recorder->wires.line, logical, cycle);
    }
}

unsigned recorder_active(const struct recorder *recorder, unsigned signal, unsigned count)
{
    unsigned active = 0;
    for (unsigned i = 0; i < count; i++) {
        active |= recorder->level[signal + i] ? 1U << i : 0U;
    }
    return active;
}

bool recorder_close(struct recorder *recorder)
{
    begin_steps(recorder);
    waves_end(&recorder->waves, clock_now_ps(recorder->wires.clock) / VTIME_PS_PER_NS);
    bool good = outfile_close(&recorder->steps);
    good = outfile_close(&recorder->waves.file) && good;
    return good && outfile_publish(&recorder->steps) && outfile_publish(&recorder->waves.file);
}

void recorder_discard(struct recorder *recorder)
{
    outfile_discard(&recorder->steps);
    outfile_discard(&recorder->waves.file);
}
