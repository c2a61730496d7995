#include "waves.h"

#include <assert.h>

#include "hal_io.h"
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
    SIGNAL_PWM = SIGNAL_SPEEDS + UNIT_MOTORS,
    SIGNAL_LEDS,
    SIGNALS = SIGNAL_LEDS + HAL_IO_LEDS,
};

enum {
    MILLI_PERCENT_PER_PERMILLE = 100
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

/* An LED with a name of its own, or that of a motor. */
static unsigned led_wire(const struct waves *waves, unsigned led)
{
    return waves->kind->leds != NULL ? SIGNAL_LEDS + led : motor_wire(led, SIGNAL_LED);
}

static void declare_motors(struct waves *waves)
{
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        declare(waves, VCD_WIRE, motor_wire(i, SIGNAL_STEP), "m", i, "_step");
        declare(waves, VCD_WIRE, motor_wire(i, SIGNAL_DIRECTION), "m", i, "_dir");
        if (waves->kind->leds == NULL) {
            declare(waves, VCD_WIRE, motor_wire(i, SIGNAL_LED), "m", i, "_led");
        }
    }
}

/* What not every kind of unit has. */
static void declare_special(struct waves *waves)
{
    for (unsigned i = 0; waves->kind->leds != NULL && i < HAL_IO_LEDS; i++) {
        vcd_declare(&waves->vcd, VCD_WIRE, SIGNAL_LEDS + i,
                    (struct vcd_name){.before = waves->kind->leds[i], .after = ""});
    }
    if (waves->kind->has_pwm) {
        vcd_declare(&waves->vcd, VCD_REAL, SIGNAL_PWM, (struct vcd_name){.before = "pwm", .after = ""});
    }
}

static void declare_all(struct waves *waves)
{
    declare_motors(waves);
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
    declare_special(waves);
}

static void put_first_motor(struct waves *waves, unsigned motor)
{
    vcd_put_wire(&waves->vcd, motor_wire(motor, SIGNAL_STEP), false);
    vcd_put_wire(&waves->vcd, motor_wire(motor, SIGNAL_DIRECTION), false);
    if (waves->kind->leds == NULL) {
        vcd_put_wire(&waves->vcd, motor_wire(motor, SIGNAL_LED), false);
    }
}

static void put_first_values(struct waves *waves)
{
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        put_first_motor(waves, i);
    }
    for (unsigned i = 0; i < UNIT_INPUTS; i++) {
        vcd_put_wire(&waves->vcd, SIGNAL_INPUTS + i, ((unsigned)waves->inputs >> i & 1U) != 0);
    }
    for (unsigned i = 0; i < UNIT_OUTPUTS; i++) {
        vcd_put_wire(&waves->vcd, SIGNAL_OUTPUTS + i, false);
    }
    for (unsigned i = SIGNAL_POSITIONS; i < SIGNAL_PWM; i++) {
        vcd_put_whole(&waves->vcd, i, 0);
    }
    for (unsigned i = 0; waves->kind->leds != NULL && i < HAL_IO_LEDS; i++) {
        vcd_put_wire(&waves->vcd, SIGNAL_LEDS + i, false);
    }
    if (waves->kind->has_pwm) {
        vcd_put_whole(&waves->vcd, SIGNAL_PWM, 0);
    }
}

void waves_begin(struct waves *waves, struct outfile *file, const struct unit_kind *kind)
{
    *waves = (struct waves){.kind = kind, .inputs = kind->inputs_turned};
    vcd_begin(&waves->vcd, file, kind->program);
    declare_all(waves);
    vcd_begin_values(&waves->vcd);
    put_first_values(waves);
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

static void put_step_pin(struct waves *waves, unsigned motor, bool high)
{
    waves->pins[motor].high = high;
    vcd_put_wire(&waves->vcd, motor_wire(motor, SIGNAL_STEP), high != waves->pins[motor].falling);
}

static void put_direction_pin(struct waves *waves, unsigned motor, bool backward)
{
    waves->pins[motor].backward = backward;
    vcd_put_wire(&waves->vcd, motor_wire(motor, SIGNAL_DIRECTION), backward != waves->pins[motor].turned);
}

static void put_polarity(struct waves *waves, const struct timeline_event *event)
{
    struct waves_pins *pins = &waves->pins[event->motor - 1U];
    pins->falling = event->detail != 0;
    pins->turned = event->value != 0;
    put_step_pin(waves, event->motor - 1U, pins->high);
    put_direction_pin(waves, event->motor - 1U, pins->backward);
}

static void put_step(struct waves *waves, const struct timeline_event *event)
{
    unsigned motor = event->motor - 1U;
    put_step_pin(waves, motor, true);
    put_position(waves, motor, event->value);
    put_speed(waves, motor, units_milli_speed(event->interval_ticks));
}

static bool is_drawn(const struct timeline_event *event)
{
    return event->kind != TIMELINE_TRACE || (event->detail == HAL_TRACE_DONE && event->motor != 0);
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
        put_step_pin(waves, motor, false);
        break;
    case TIMELINE_POSITION:
        put_position(waves, motor, event->value);
        break;
    case TIMELINE_DIRECTION:
        put_direction_pin(waves, motor, level);
        break;
    case TIMELINE_POLARITY:
        put_polarity(waves, event);
        break;
    case TIMELINE_LED:
        vcd_put_wire(&waves->vcd, led_wire(waves, motor), level);
        break;
    case TIMELINE_PWM:
        vcd_put_milli(&waves->vcd, SIGNAL_PWM, (uint64_t)event->value * MILLI_PERCENT_PER_PERMILLE);
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
