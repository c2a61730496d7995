#include "waves.h"

#include <assert.h>

#include "hal_trace.h"
#include "units.h"

/* Signals by number. */
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

static_assert(SIGNALS <= VCD_SIGNALS_MAX, "a signal's code is one character");

static unsigned motor_wire(unsigned motor, enum signal wire)
{
    return motor * SIGNALS_PER_MOTOR + (unsigned)wire;
}

static void put_position(struct waves *waves, unsigned motor, int64_t position)
{
    vcd_put_whole(&waves->vcd, SIGNAL_POSITIONS + motor, position);
}

static void put_speed(struct waves *waves, unsigned motor, uint64_t milli_speed)
{
    if (milli_speed != waves->milli_speed[motor]) {
        waves->milli_speed[motor] = milli_speed;
        vcd_put_milli(&waves->vcd, SIGNAL_SPEEDS + motor, milli_speed);
    }
}

static void declare(struct waves *waves, enum vcd_type type, unsigned signal, const char *before, unsigned index,
                    const char *after)
{
    vcd_declare(&waves->vcd, type, signal, (struct vcd_name){.before = before, .number = index + 1U, .after = after});
}

static void declare_all(struct waves *waves)
{
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        declare(waves, VCD_WIRE, motor_wire(i, SIGNAL_STEP), "m", i, "_step");
        declare(waves, VCD_WIRE, motor_wire(i, SIGNAL_DIRECTION), "m", i, "_dir");
        declare(waves, VCD_WIRE, motor_wire(i, SIGNAL_LED), "m", i, "_led");
    }
    for (unsigned i = 0; i < UNIT_INPUTS; i++) {
        declare(waves, VCD_WIRE, SIGNAL_INPUTS + i, "bi", i, "");
    }
    for (unsigned i = 0; i < UNIT_OUTPUTS; i++) {
        declare(waves, VCD_WIRE, SIGNAL_OUTPUTS + i, "bo", i, "");
    }
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        declare(waves, VCD_REAL, SIGNAL_POSITIONS + i, "m", i, "_position");
        declare(waves, VCD_REAL, SIGNAL_SPEEDS + i, "m", i, "_speed");
    }
}

void waves_begin(struct waves *waves, struct outfile *file)
{
    *waves = (struct waves){.inputs = 0};
    vcd_begin(&waves->vcd, file, "rkm04-host");
    declare_all(waves);
    vcd_begin_values(&waves->vcd);
    for (unsigned i = 0; i < SIGNAL_POSITIONS; i++) {
        vcd_put_wire(&waves->vcd, i, false);
    }
    for (unsigned i = SIGNAL_POSITIONS; i < SIGNALS; i++) {
        vcd_put_whole(&waves->vcd, i, 0);
    }
    vcd_end_values(&waves->vcd);
}

static void put_changed_bits(struct waves *waves, unsigned first_signal, uint8_t *levels, uint8_t new_levels)
{
    unsigned changed = (unsigned)*levels ^ new_levels;
    for (unsigned i = 0; changed >> i != 0; i++) {
        if ((changed >> i & 1U) != 0) {
            vcd_put_wire(&waves->vcd, first_signal + i, ((unsigned)new_levels >> i & 1U) != 0);
        }
    }
    *levels = new_levels;
}

static void put_step(struct waves *waves, const struct timeline_event *event)
{
    unsigned motor = event->motor - 1U;
    vcd_put_wire(&waves->vcd, motor_wire(motor, SIGNAL_STEP), true);
    put_position(waves, motor, event->value);
    put_speed(waves, motor, units_milli_speed(event->interval_ticks));
}

static bool is_drawn(const struct timeline_event *event)
{
    return event->kind != TIMELINE_TRACE || event->detail == HAL_TRACE_DONE;
}

static void put_change(struct waves *waves, const struct timeline_event *event)
{
    unsigned motor = event->motor - 1U;
    bool level = event->value != 0;
    switch ((enum timeline_kind)event->kind) {
    case TIMELINE_STEP:
        put_step(waves, event);
        break;
    case TIMELINE_STEP_END:
        vcd_put_wire(&waves->vcd, motor_wire(motor, SIGNAL_STEP), false);
        break;
    case TIMELINE_POSITION:
        put_position(waves, motor, event->value);
        break;
    case TIMELINE_DIRECTION:
        vcd_put_wire(&waves->vcd, motor_wire(motor, SIGNAL_DIRECTION), level);
        break;
    case TIMELINE_LED:
        vcd_put_wire(&waves->vcd, motor_wire(motor, SIGNAL_LED), level);
        break;
    case TIMELINE_INPUT:
        put_changed_bits(waves, SIGNAL_INPUTS, &waves->inputs, (uint8_t)event->value);
        break;
    case TIMELINE_OUTPUT:
        put_changed_bits(waves, SIGNAL_OUTPUTS, &waves->outputs, (uint8_t)event->value);
        break;
    case TIMELINE_TRACE:
        put_speed(waves, motor, 0);
        break;
    }
}

/* An event that was told too late stands at the time of the one before. */
void waves_put(struct waves *waves, const struct timeline_event *event)
{
    if (is_drawn(event)) {
        vcd_put_time(&waves->vcd, units_ns_of_ticks(event->tick));
        put_change(waves, event);
    }
}

void waves_end(struct waves *waves, uint64_t end_tick)
{
    vcd_put_time(&waves->vcd, units_ns_of_ticks(end_tick));
}
