#include "vcd.h"

#include "line.h"
#include "vtime.h"

enum {
    LINE_BYTES_MAX = 128,
    SIGNAL_WIRES = SIGNAL_SWITCH, /* the switch is not shown */
    SIGNAL_POSITION = SIGNAL_WIRES,
    SIGNAL_SPEED = SIGNAL_POSITION + PINS_MOTORS,
    MILLI = 1000,
    MILLI_DECIMALS = 3,
};

#define REST_NS UINT64_C(50000000)

static char *put_code(char *at, unsigned signal)
{
    *at++ = (char)('!' + (char)signal);
    *at++ = '\n';
    return at;
}

static void put_line(struct vcd *vcd, const char *line)
{
    outfile_commit(&vcd->file, line_put_string(outfile_reserve(&vcd->file, LINE_BYTES_MAX), line));
}

static void declare(struct vcd *vcd, const char *type, unsigned signal, const char *before, unsigned number,
                    const char *after)
{
    char *at = line_put_string(outfile_reserve(&vcd->file, LINE_BYTES_MAX), "$var ");
    at = line_put_string(at, type);
    *at++ = ' ';
    *at++ = (char)('!' + (char)signal);
    *at++ = ' ';
    at = line_put_string(at, before);
    at = number == 0 ? at : line_put_unsigned(at, number);
    at = line_put_string(at, after);
    outfile_commit(&vcd->file, line_put_string(at, " $end\n"));
}

static void declare_all(struct vcd *vcd)
{
    for (unsigned i = 0; i < PINS_MOTORS; i++) {
        declare(vcd, "wire 1", SIGNAL_STEP + i, "m", i + 1U, "_step");
        declare(vcd, "wire 1", SIGNAL_DIRECTION + i, "m", i + 1U, "_dir");
        declare(vcd, "wire 1", SIGNAL_LED + i, "m", i + 1U, "_led");
    }
    for (unsigned i = 0; i < PINS_INPUTS; i++) {
        declare(vcd, "wire 1", SIGNAL_INPUT + i, "bi", i + 1U, "");
    }
    for (unsigned i = 0; i < PINS_OUTPUTS; i++) {
        declare(vcd, "wire 1", SIGNAL_OUTPUT + i, "bo", i + 1U, "");
    }
    declare(vcd, "wire 1", SIGNAL_DRIVER, "de", 0, "");
    for (unsigned i = 0; i < PINS_MOTORS; i++) {
        declare(vcd, "real 64", SIGNAL_POSITION + i, "m", i + 1U, "_position");
        declare(vcd, "real 64", SIGNAL_SPEED + i, "m", i + 1U, "_speed");
    }
}

static char *put_wire(char *at, unsigned signal, bool level)
{
    *at++ = level ? '1' : '0';
    return put_code(at, signal);
}

void vcd_begin(struct vcd *vcd, const bool levels[SIGNALS])
{
    if (!outfile_is_open(&vcd->file)) {
        return;
    }
    put_line(vcd, "$version rkm04-vboard $end\n$timescale 1 ns $end\n$scope module rkm04 $end\n");
    declare_all(vcd);
    put_line(vcd, "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n");
    for (unsigned i = 0; i < SIGNAL_WIRES; i++) {
        outfile_commit(&vcd->file, put_wire(outfile_reserve(&vcd->file, LINE_BYTES_MAX), i, levels[i]));
    }
    for (unsigned i = SIGNAL_POSITION; i < SIGNAL_SPEED + PINS_MOTORS; i++) {
        char *at = line_put_string(outfile_reserve(&vcd->file, LINE_BYTES_MAX), "r0 ");
        outfile_commit(&vcd->file, put_code(at, i));
    }
    put_line(vcd, "$end\n");
}

static void put_time(struct vcd *vcd, uint64_t ns)
{
    if (ns > vcd->written_ns) {
        char *at = outfile_reserve(&vcd->file, LINE_BYTES_MAX);
        vcd->written_ns = ns;
        *at++ = '#';
        at = line_put_unsigned(at, ns);
        *at++ = '\n';
        outfile_commit(&vcd->file, at);
    }
}

/* Motors that came to rest before a time, in order. */
static void put_rests(struct vcd *vcd, uint64_t ns)
{
    for (;;) {
        unsigned first = PINS_MOTORS;
        for (unsigned i = 0; i < PINS_MOTORS; i++) {
            bool rests = vcd->is_fast[i] && vcd->pulse_ns[i] + REST_NS <= ns;
            if (rests && (first == PINS_MOTORS || vcd->pulse_ns[i] < vcd->pulse_ns[first])) {
                first = i;
            }
        }
        if (first == PINS_MOTORS) {
            return;
        }
        put_time(vcd, vcd->pulse_ns[first] + REST_NS);
        char *at = line_put_string(outfile_reserve(&vcd->file, LINE_BYTES_MAX), "r0 ");
        outfile_commit(&vcd->file, put_code(at, SIGNAL_SPEED + first));
        vcd->is_fast[first] = false;
    }
}

void vcd_put_wire(struct vcd *vcd, unsigned signal, bool level, uint64_t ns)
{
    if (!outfile_is_open(&vcd->file) || signal >= SIGNAL_WIRES) {
        return;
    }
    put_rests(vcd, ns);
    put_time(vcd, ns);
    outfile_commit(&vcd->file, put_wire(outfile_reserve(&vcd->file, LINE_BYTES_MAX), signal, level));
}

void vcd_put_pulse(struct vcd *vcd, unsigned motor, int64_t position, uint64_t hz, uint64_t interval)
{
    if (!outfile_is_open(&vcd->file)) {
        return;
    }
    char *at = outfile_reserve(&vcd->file, LINE_BYTES_MAX);
    *at++ = 'r';
    at = line_put_signed(at, position);
    *at++ = ' ';
    at = put_code(at, SIGNAL_POSITION + motor);
    if (interval != 0 && vcd->is_fast[motor]) {
        *at++ = 'r';
        at = line_put_fixed(at, vtime_scale(hz, MILLI, interval), MILLI_DECIMALS);
        *at++ = ' ';
        at = put_code(at, SIGNAL_SPEED + motor);
    }
    vcd->is_fast[motor] = true;
    vcd->pulse_ns[motor] = vcd->written_ns;
    outfile_commit(&vcd->file, at);
}

void vcd_end(struct vcd *vcd, uint64_t ns)
{
    if (outfile_is_open(&vcd->file)) {
        put_rests(vcd, ns);
        put_time(vcd, ns);
    }
}
