#include "rkm04_kind.h"

#include "interpreter.h"
#include "rkm04.h"

static const char *const stop_texts[AXIS_CAUSES] = {
#define X(name, text) [AXIS_CAUSE_##name] = (text),
    INTERPRETER_CAUSES(X)
#undef X
};

static void begin(void *context)
{
    rkm04_init(context);
    rkm04_start(context);
}

static uint64_t poll(void *context)
{
    return rkm04_poll(context);
}

static bool is_idle(const void *context)
{
    return rkm04_is_idle(context);
}

static bool is_talking(const void *context)
{
    const struct rkm04 *unit = context;
    return unit->line.link.waiting || link_is_sending(&unit->line.link);
}

static int64_t position_steps(const void *context, unsigned motor)
{
    const struct rkm04 *unit = context;
    return axis_position_steps(&unit->axis[motor]);
}

static bool is_moving(const void *context, unsigned motor)
{
    const struct rkm04 *unit = context;
    return axis_is_moving(&unit->axis[motor]);
}

static const char *trace_text(enum hal_trace_event event, int64_t value)
{
    if (event == HAL_TRACE_STOP) {
        return stop_texts[value];
    }
    return event == HAL_TRACE_ERROR ? interpreter_error_text((enum interpreter_error)value) : NULL;
}

const struct unit_kind rkm04_kind = {
    .program = "rkm04-host",
    .bytes = sizeof(struct rkm04),
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
