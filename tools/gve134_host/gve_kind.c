#include "gve_kind.h"

#include "arguments.h"
#include "base_tick.h"
#include "gve134.h"
#include "hal_io.h"

enum {
    BITS_PER_BYTE = 10
};

static const uint64_t bauds[] = {38400, 57600, 115200, 230400, 460800, 921600};

static const char *const leds[HAL_IO_LEDS] = {
    "led_power", "led_run", "led_data", "led_relay", "led_refx", "led_refy", "led_refz", "led_refa",
};

static const char *const stop_texts[AXIS_CAUSES] = {
    [AXIS_CAUSE_NONE] = "none",    [AXIS_CAUSE_PAUSE] = "pause", [AXIS_CAUSE_HIGH] = "interrupt",
    [AXIS_CAUSE_LOW] = "low",      [AXIS_CAUSE_ABORT] = "reset", [AXIS_CAUSE_COMMAND] = "halt",
    [AXIS_CAUSE_LIMIT] = "switch", [AXIS_CAUSE_FAULT] = "fault",
};

static void begin(void *context)
{
    gve134_init(context);
    gve134_start(context);
}

static uint64_t poll(void *context)
{
    return gve134_poll(context);
}

static bool is_idle(const void *context)
{
    return gve134_is_idle(context);
}

static bool is_talking(const void *context)
{
    const struct gve134 *unit = context;
    return unit->line.count > 0 || gve_line_is_sending(&unit->line);
}

static int64_t position_steps(const void *context, unsigned motor)
{
    const struct gve134 *unit = context;
    return step_channel_position(&unit->queue.channel[motor]);
}

static bool is_moving(const void *context, unsigned motor)
{
    const struct gve134 *unit = context;
    (void)motor;
    return gve_queue_moves(&unit->queue);
}

static const char *trace_text(enum hal_trace_event event, int64_t value)
{
    return event == HAL_TRACE_STOP ? stop_texts[value] : NULL;
}

const struct unit_kind gve_kind_of_unit = {
    .program = "gve134-host",
    .bytes = sizeof(struct gve134),
    .begin = begin,
    .poll = poll,
    .is_idle = is_idle,
    .is_talking = is_talking,
    .position_steps = position_steps,
    .is_moving = is_moving,
    .trace_text = trace_text,
    .leds = leds,
    .has_pwm = true,
    .moves_together = true,
    .traces_positions = true,
    .inputs_used = 0xCF,
    .inputs_turned = 0xFF,
    .inputs_wrong = "the input must be 1 to 4, 7 or 8, then a comma",
};

uint32_t gve_byte_ticks(uint64_t baud)
{
    return (uint32_t)((TICK_HZ * (uint64_t)BITS_PER_BYTE + baud / 2U) / baud);
}

bool gve_read_baud(const char *value, uint64_t *baud)
{
    const struct argument_number range = {.most = UINT32_MAX};
    if (arguments_read_number(value, range, baud)) {
        for (unsigned i = 0; i < sizeof bauds / sizeof bauds[0]; i++) {
            if (bauds[i] == *baud) {
                return true;
            }
        }
    }
    complain("--baud %s: no rate of the unit; write 38400, 57600, 115200, 230400, 460800 or 921600", value);
    return false;
}
