#include "waves.h"

#include <assert.h>

#include "vtime.h"

enum {
    SIGNAL_WIRES = SIGNAL_SWITCH, /* the switch is not shown */
    SIGNAL_POSITION = SIGNAL_WIRES,
    SIGNAL_SPEED = SIGNAL_POSITION + PINS_MOTORS,
    SIGNALS_SHOWN = SIGNAL_SPEED + PINS_MOTORS,
    MILLI = 1000,
};

static_assert(SIGNALS_SHOWN <= VCD_SIGNALS_MAX, "a signal's code is one character");

#define REST_NS UINT64_C(50000000)

static void declare(struct waves *waves, enum vcd_type type, unsigned signal, const char *before, unsigned index,
                    const char *after)
{
    vcd_declare(&waves->vcd, type, signal, (struct vcd_name){.before = before, .number = index + 1U, .after = after});
}

static void declare_all(struct waves *waves)
{
    for (unsigned i = 0; i < PINS_MOTORS; i++) {
        declare(waves, VCD_WIRE, SIGNAL_STEP + i, "m", i, "_step");
        declare(waves, VCD_WIRE, SIGNAL_DIRECTION + i, "m", i, "_dir");
        declare(waves, VCD_WIRE, SIGNAL_LED + i, "m", i, "_led");
        declare(waves, VCD_WIRE, SIGNAL_ENABLE + i, "m", i, "_en");
    }
    for (unsigned i = 0; i < PINS_INPUTS; i++) {
        declare(waves, VCD_WIRE, SIGNAL_INPUT + i, "bi", i, "");
    }
    for (unsigned i = 0; i < PINS_OUTPUTS; i++) {
        declare(waves, VCD_WIRE, SIGNAL_OUTPUT + i, "bo", i, "");
    }
    for (unsigned i = 0; i < PINS_MORE_LEDS; i++) {
        declare(waves, VCD_WIRE, SIGNAL_MORE_LED + i, "led", PINS_MORE_LEDS_FIRST - 1U + i, "");
    }
    vcd_declare(&waves->vcd, VCD_WIRE, SIGNAL_PWM, (struct vcd_name){.before = "pwm", .after = ""});
    vcd_declare(&waves->vcd, VCD_WIRE, SIGNAL_DRIVER, (struct vcd_name){.before = "de", .after = ""});
    for (unsigned i = 0; i < PINS_MOTORS; i++) {
        declare(waves, VCD_REAL, SIGNAL_POSITION + i, "m", i, "_position");
        declare(waves, VCD_REAL, SIGNAL_SPEED + i, "m", i, "_speed");
    }
}

void waves_begin(struct waves *waves, const bool levels[SIGNALS])
{
    if (!outfile_is_open(&waves->file)) {
        return;
    }
    vcd_begin(&waves->vcd, &waves->file, "rkm04-vboard");
    declare_all(waves);
    vcd_begin_values(&waves->vcd);
    for (unsigned i = 0; i < SIGNAL_WIRES; i++) {
        vcd_put_wire(&waves->vcd, i, levels[i]);
    }
    for (unsigned i = SIGNAL_POSITION; i < SIGNALS_SHOWN; i++) {
        vcd_put_whole(&waves->vcd, i, 0);
    }
    vcd_end_values(&waves->vcd);
}

/* Motors that came to rest before a time, in order. */
static void put_rests(struct waves *waves, uint64_t ns)
{
    for (;;) {
        unsigned first = PINS_MOTORS;
        for (unsigned i = 0; i < PINS_MOTORS; i++) {
            bool rests = waves->is_fast[i] && waves->pulse_ns[i] + REST_NS <= ns;
            if (rests && (first == PINS_MOTORS || waves->pulse_ns[i] < waves->pulse_ns[first])) {
                first = i;
            }
        }
        if (first == PINS_MOTORS) {
            return;
        }
        vcd_put_time(&waves->vcd, waves->pulse_ns[first] + REST_NS);
        vcd_put_whole(&waves->vcd, SIGNAL_SPEED + first, 0);
        waves->is_fast[first] = false;
    }
}

void waves_put_wire(struct waves *waves, unsigned signal, bool level, uint64_t ns)
{
    if (!outfile_is_open(&waves->file) || signal >= SIGNAL_WIRES) {
        return;
    }
    put_rests(waves, ns);
    vcd_put_time(&waves->vcd, ns);
    vcd_put_wire(&waves->vcd, signal, level);
}

void waves_put_pulse(struct waves *waves, unsigned motor, int64_t position, uint64_t hz, uint64_t interval)
{
    if (!outfile_is_open(&waves->file)) {
        return;
    }
    vcd_put_whole(&waves->vcd, SIGNAL_POSITION + motor, position);
    if (interval != 0 && waves->is_fast[motor]) {
        vcd_put_milli(&waves->vcd, SIGNAL_SPEED + motor, vtime_scale(hz, MILLI, interval));
    }
    waves->is_fast[motor] = true;
    waves->pulse_ns[motor] = waves->vcd.written_ns;
}

void waves_end(struct waves *waves, uint64_t ns)
{
    if (outfile_is_open(&waves->file)) {
        put_rests(waves, ns);
        vcd_put_time(&waves->vcd, ns);
    }
}
