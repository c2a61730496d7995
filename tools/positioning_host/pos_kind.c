#include "pos_kind.h"

#include "positioning.h"

static const char *const stop_texts[AXIS_CAUSES] = {
    [AXIS_CAUSE_NONE] = "none",    [AXIS_CAUSE_PAUSE] = "hold",  [AXIS_CAUSE_HIGH] = "reference",
    [AXIS_CAUSE_LOW] = "low",      [AXIS_CAUSE_ABORT] = "abort", [AXIS_CAUSE_COMMAND] = "command",
    [AXIS_CAUSE_LIMIT] = "switch", [AXIS_CAUSE_FAULT] = "fault",
};

static void begin(void *context)
{
    positioning_init(context);
    positioning_start(context);
}

static uint64_t poll(void *context)
{
    return positioning_poll(context);
}

static bool is_idle(const void *context)
{
    return positioning_is_idle(context);
}

static bool is_talking(const void *context)
{
    const struct pos_unit *unit = context;
    return modbus_is_sending(&unit->server);
}

static int64_t position_steps(const void *context, unsigned motor)
{
    const struct pos_unit *unit = context;
    return pos_drive_steps(&unit->axes[motor].drive);
}

static bool is_moving(const void *context, unsigned motor)
{
    const struct pos_unit *unit = context;
    return pos_axis_is_busy(&unit->axes[motor]);
}

static const char *trace_text(enum hal_trace_event event, int64_t value)
{
    return event == HAL_TRACE_STOP ? stop_texts[value] : NULL;
}

const struct unit_kind pos_kind_of_unit = {
    .program = "positioning-host",
    .bytes = sizeof(struct pos_unit),
    .begin = begin,
    .poll = poll,
    .is_idle = is_idle,
    .is_talking = is_talking,
    .position_steps = position_steps,
    .is_moving = is_moving,
    .trace_text = trace_text,
    .inputs_used = 0xFF,
    .inputs_wrong = "the input must be 1 to 8, then a comma",
};
