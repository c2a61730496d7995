#include "vcd.h"

#include <assert.h>

#include "hal_trace.h"
#include "line.h"
#include "units.h"

enum {
    LINE_BYTES_MAX = 128
};

/* Signals by number; the code of a signal in the file is one printable character from '!' on. */
enum signal {
    SIGNAL_STEP,
    SIGNAL_DIRECTION,
    SIGNAL_LED,
    SIGNALS_PER_MOTOR,

    SIGNAL_INPUTS = UNIT_MOTORS * SIGNALS_PER_MOTOR,
    SIGNAL_OUTPUTS = SIGNAL_INPUTS + UNIT_INPUTS,
    SIGNAL_POSITIONS = SIGNAL_OUTPUTS + UNIT_OUTPUTS,
    SIGNAL_SPEEDS = SIGNAL_POSITIONS + UNIT_MOTORS,
    SIGNALS = SIGNAL_SPEEDS + UNIT_MOTORS,
};

static_assert('!' + SIGNALS <= '~', "a signal's code is one character");

static unsigned motor_wire(unsigned motor, enum signal wire)
{
    return motor * SIGNALS_PER_MOTOR + (unsigned)wire;
}

static char *put_code(char *at, unsigned signal)
{
    *at++ = (char)('!' + (char)signal);
    *at++ = '\n';
    return at;
}

static char *put_wire(char *at, unsigned signal, bool level)
{
    *at++ = level ? '1' : '0';
    return put_code(at, signal);
}

static char *put_position(char *at, unsigned motor, int64_t position)
{
    *at++ = 'r';
    at = line_put_signed(at, position);
    *at++ = ' ';
    return put_code(at, SIGNAL_POSITIONS + motor);
}

static char *put_speed(struct vcd *vcd, char *at, unsigned motor, uint64_t milli_speed)
{
    if (milli_speed == vcd->milli_speed[motor]) {
        return at;
    }
    vcd->milli_speed[motor] = milli_speed;
    *at++ = 'r';
    at = line_put_fixed(at, milli_speed, 3);
    *at++ = ' ';
    return put_code(at, SIGNAL_SPEEDS + motor);
}

/* "$var wire 1 ! m1_step $end". */
static void declare(struct vcd *vcd, const char *type, unsigned signal, const char *before, unsigned number,
                    const char *after)
{
    char *at = outfile_reserve(vcd->file, LINE_BYTES_MAX);
    at = line_put_string(at, "$var ");
    at = line_put_string(at, type);
    *at++ = ' ';
    *at++ = (char)('!' + (char)signal);
    *at++ = ' ';
    at = line_put_string(at, before);
    at = line_put_unsigned(at, number);
    at = line_put_string(at, after);
    at = line_put_string(at, " $end\n");
    outfile_commit(vcd->file, at);
}

static void put_line(struct vcd *vcd, const char *line)
{
    outfile_commit(vcd->file, line_put_string(outfile_reserve(vcd->file, LINE_BYTES_MAX), line));
}

static void declare_all(struct vcd *vcd)
{
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        declare(vcd, "wire 1", motor_wire(i, SIGNAL_STEP), "m", i + 1U, "_step");
        declare(vcd, "wire 1", motor_wire(i, SIGNAL_DIRECTION), "m", i + 1U, "_dir");
        declare(vcd, "wire 1", motor_wire(i, SIGNAL_LED), "m", i + 1U, "_led");
    }
    for (unsigned i = 0; i < UNIT_INPUTS; i++) {
        declare(vcd, "wire 1", SIGNAL_INPUTS + i, "bi", i + 1U, "");
    }
    for (unsigned i = 0; i < UNIT_OUTPUTS; i++) {
        declare(vcd, "wire 1", SIGNAL_OUTPUTS + i, "bo", i + 1U, "");
    }
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        declare(vcd, "real 64", SIGNAL_POSITIONS + i, "m", i + 1U, "_position");
        declare(vcd, "real 64", SIGNAL_SPEEDS + i, "m", i + 1U, "_speed");
    }
}

void vcd_begin(struct vcd *vcd, struct outfile *file)
{
    *vcd = (struct vcd){.file = file};
    put_line(vcd, "$version rkm04-host $end\n$timescale 1 ns $end\n$scope module rkm04 $end\n");
    declare_all(vcd);
    put_line(vcd, "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n");
    for (unsigned i = 0; i < SIGNALS; i++) {
        char *at = outfile_reserve(vcd->file, LINE_BYTES_MAX);
        bool is_real = i >= SIGNAL_POSITIONS;
        outfile_commit(vcd->file, put_code(line_put_string(at, is_real ? "r0 " : "0"), i));
    }
    put_line(vcd, "$end\n");
}

/* An event that was told too late stands at the time of the one before: time in the file never goes back. */
static char *put_time(struct vcd *vcd, char *at, uint64_t tick)
{
    uint64_t ns = units_ns_of_ticks(tick);
    if (ns <= vcd->written_ns) {
        return at;
    }
    vcd->written_ns = ns;
    *at++ = '#';
    at = line_put_unsigned(at, ns);
    *at++ = '\n';
    return at;
}

static char *put_changed_bits(char *at, unsigned first_signal, uint8_t *levels, uint8_t new_levels)
{
    unsigned changed = (unsigned)*levels ^ new_levels;
    for (unsigned i = 0; changed >> i != 0; i++) {
        if ((changed >> i & 1U) != 0) {
            at = put_wire(at, first_signal + i, ((unsigned)new_levels >> i & 1U) != 0);
        }
    }
    *levels = new_levels;
    return at;
}

static char *put_step(struct vcd *vcd, char *at, const struct timeline_event *event)
{
    unsigned motor = event->motor - 1U;
    at = put_wire(at, motor_wire(motor, SIGNAL_STEP), true);
    at = put_position(at, motor, event->value);
    return put_speed(vcd, at, motor, units_milli_speed(event->interval_ticks));
}

static bool is_drawn(const struct timeline_event *event)
{
    return event->kind != TIMELINE_TRACE || event->detail == HAL_TRACE_DONE;
}

static char *put_change(struct vcd *vcd, char *at, const struct timeline_event *event)
{
    unsigned motor = event->motor - 1U;
    bool level = event->value != 0;
    switch ((enum timeline_kind)event->kind) {
    case TIMELINE_STEP:
        return put_step(vcd, at, event);
    case TIMELINE_STEP_END:
        return put_wire(at, motor_wire(motor, SIGNAL_STEP), false);
    case TIMELINE_POSITION:
        return put_position(at, motor, event->value);
    case TIMELINE_DIRECTION:
        return put_wire(at, motor_wire(motor, SIGNAL_DIRECTION), level);
    case TIMELINE_LED:
        return put_wire(at, motor_wire(motor, SIGNAL_LED), level);
    case TIMELINE_INPUT:
        return put_changed_bits(at, SIGNAL_INPUTS, &vcd->inputs, (uint8_t)event->value);
    case TIMELINE_OUTPUT:
        return put_changed_bits(at, SIGNAL_OUTPUTS, &vcd->outputs, (uint8_t)event->value);
    case TIMELINE_TRACE:
        return put_speed(vcd, at, motor, 0);
    }
    return at;
}

void vcd_put(struct vcd *vcd, const struct timeline_event *event)
{
    if (is_drawn(event)) {
        char *at = put_time(vcd, outfile_reserve(vcd->file, LINE_BYTES_MAX), event->tick);
        outfile_commit(vcd->file, put_change(vcd, at, event));
    }
}

void vcd_end(struct vcd *vcd, uint64_t end_tick)
{
    outfile_commit(vcd->file, put_time(vcd, outfile_reserve(vcd->file, LINE_BYTES_MAX), end_tick));
}
