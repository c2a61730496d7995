#include "recorder.h"

#include "board.h"
#include "line.h"

#define TICK_HZ UINT64_C(84000000) /* of the unit, where TIM2 does not run */

enum {
    LINE_BYTES_MAX = 128
};

static uint64_t tick_hz(const struct board *board)
{
    bool started = board->timer[0].start_cycle != VTIME_NEVER;
    return started ? board->time.hclk_hz / timer_tick_cycles(board, 0) : TICK_HZ;
}

uint64_t recorder_tick(const struct board *board, uint64_t cycle)
{
    uint64_t start = board->timer[0].start_cycle;
    if (start == VTIME_NEVER || cycle < start) {
        return vtime_scale(vtime_ps_of_cycle(&board->time, cycle), TICK_HZ, VTIME_PS_PER_SECOND);
    }
    uint64_t ticks = (cycle - start) / timer_tick_cycles(board, 0);
    return ticks + (board->options->ticks_from_timer
                        ? 0
                        : vtime_scale(vtime_ps_of_cycle(&board->time, start), tick_hz(board), VTIME_PS_PER_SECOND));
}

bool recorder_open(struct board *board)
{
    struct recorder *recorder = &board->recorder;
    for (unsigned i = 0; i < SIGNALS; i++) {
        recorder->level[i] = board->pins.low[i];
    }
    for (unsigned i = 0; i < PINS_MOTORS; i++) {
        recorder->motor[i] = (struct recorder_motor){.width_least_ps = VTIME_NEVER,
                                                     .gap_least_ps = VTIME_NEVER,
                                                     .period_least_ps = VTIME_NEVER,
                                                     .setup_least_ps = VTIME_NEVER,
                                                     .hold_least_ps = VTIME_NEVER};
    }
    recorder->first_step_ps = VTIME_NEVER;
    if (!outfile_open(&recorder->steps, board->options->steps) ||
        !outfile_open(&recorder->vcd.file, board->options->vcd)) {
        return false;
    }
    vcd_begin(&recorder->vcd, recorder->level);
    return true;
}

/* The table begins when the rate of the timer is known. */
static void begin_steps(struct board *board)
{
    struct recorder *recorder = &board->recorder;
    uint64_t hz = tick_hz(board);
    if (recorder->tick_hz == hz) {
        return;
    }
    if (recorder->tick_hz != 0) {
        board_warn(board, "the step timer has changed its rate; the ticks of the table do not fit together");
        return;
    }
    recorder->tick_hz = hz;
    if (outfile_is_open(&recorder->steps)) {
        char *at = line_put_string(outfile_reserve(&recorder->steps, LINE_BYTES_MAX), "# tick_hz=");
        at = line_put_unsigned(at, hz);
        outfile_commit(&recorder->steps, line_put_string(at, "\ntick,motor,position\n"));
    }
}

static void write_step(struct board *board, unsigned motor, uint64_t cycle)
{
    struct recorder *recorder = &board->recorder;
    begin_steps(board);
    if (outfile_is_open(&recorder->steps)) {
        char *at = line_put_unsigned(outfile_reserve(&recorder->steps, LINE_BYTES_MAX), recorder_tick(board, cycle));
        *at++ = ',';
        at = line_put_unsigned(at, motor + 1U);
        *at++ = ',';
        at = line_put_signed(at, recorder->motor[motor].position);
        *at++ = '\n';
        outfile_commit(&recorder->steps, at);
    }
}

/* The shortest time between two events, where there were both. */
static void note_time(struct board *board, uint64_t *least_ps, uint64_t from_cycle, uint64_t cycle)
{
    uint64_t ps = vtime_scale(cycle - from_cycle, VTIME_PS_PER_SECOND, board->time.hclk_hz);
    if (from_cycle >= board->time.anchor_cycle && ps < *least_ps) {
        *least_ps = ps;
    }
}

static void note_pulse(struct board *board, unsigned index, uint64_t cycle)
{
    struct recorder *recorder = &board->recorder;
    struct recorder_motor *motor = &recorder->motor[index];
    motor->position += recorder->level[SIGNAL_DIRECTION + index] ? -1 : 1;
    if (recorder->first_step_ps == VTIME_NEVER) {
        recorder->first_step_ps = vtime_ps_of_cycle(&board->time, cycle);
    }
    if (motor->pulses > 0) {
        note_time(board, &motor->period_least_ps, motor->rise_cycle, cycle);
        note_time(board, &motor->gap_least_ps, motor->fall_cycle, cycle);
    }
    if (motor->direction_fresh) {
        note_time(board, &motor->setup_least_ps, motor->turn_cycle, cycle);
    }
    uint64_t interval = motor->pulses > 0 ? cycle - motor->rise_cycle : 0;
    motor->direction_fresh = false;
    motor->pulses++;
    motor->rise_cycle = cycle;
    write_step(board, index, cycle);
    vcd_put_pulse(&recorder->vcd, index, motor->position, board->time.hclk_hz, interval);
}

static void note_step_level(struct board *board, unsigned index, bool level, uint64_t cycle)
{
    struct recorder_motor *motor = &board->recorder.motor[index];
    if (level) {
        note_pulse(board, index, cycle);
        return;
    }
    motor->fall_cycle = cycle;
    if (motor->pulses > 0) {
        note_time(board, &motor->width_least_ps, motor->rise_cycle, cycle);
    }
}

static void note_direction(struct board *board, unsigned index, uint64_t cycle)
{
    struct recorder_motor *motor = &board->recorder.motor[index];
    if (motor->pulses > 0 && !motor->direction_fresh) {
        note_time(board, &motor->hold_least_ps, motor->rise_cycle, cycle);
    }
    motor->turn_cycle = cycle;
    motor->direction_fresh = true;
}

void recorder_note_edge(struct board *board, struct pin pin, bool level, uint64_t cycle)
{
    struct recorder *recorder = &board->recorder;
    unsigned signal = board->pins.signal[pin.port][pin.number];
    if (signal == SIGNAL_NONE) {
        return;
    }
    bool logical = level != board->pins.low[signal];
    if (recorder->level[signal] == logical) {
        return;
    }
    recorder->level[signal] = logical;
    recorder->edge_cycle[signal] = cycle;
    if (outfile_is_open(&recorder->vcd.file)) {
        vcd_put_wire(&recorder->vcd, signal, logical, vtime_ps_of_cycle(&board->time, cycle) / VTIME_PS_PER_NS);
    }
    if (signal < SIGNAL_DIRECTION) {
        note_step_level(board, signal - SIGNAL_STEP, logical, cycle);
    } else if (signal < SIGNAL_LED) {
        note_direction(board, signal - SIGNAL_DIRECTION, cycle);
    } else if (signal == SIGNAL_DRIVER) {
        rs485_note_driver(board, logical, cycle);
    }
}

unsigned recorder_active(const struct board *board, unsigned signal, unsigned count)
{
    unsigned active = 0;
    for (unsigned i = 0; i < count; i++) {
        active |= board->recorder.level[signal + i] ? 1U << i : 0U;
    }
    return active;
}

bool recorder_close(struct board *board)
{
    struct recorder *recorder = &board->recorder;
    begin_steps(board);
    vcd_end(&recorder->vcd, board_now_ps(board) / VTIME_PS_PER_NS);
    bool good = outfile_close(&recorder->steps);
    good = outfile_close(&recorder->vcd.file) && good;
    return good && outfile_publish(&recorder->steps) && outfile_publish(&recorder->vcd.file);
}

void recorder_discard(struct board *board)
{
    outfile_discard(&board->recorder.steps);
    outfile_discard(&board->recorder.vcd.file);
}
