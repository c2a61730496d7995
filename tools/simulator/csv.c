#include "csv.h"

#include "hal_trace.h"
#include "interpreter.h"
#include "line.h"

enum {
    LINE_BYTES_MAX = 256
};

static const char *const event_texts[] = {
#define X(name, text) text,
    HAL_TRACE_EVENTS(X)
#undef X
};

static const char *const stop_texts[AXIS_CAUSES] = {
#define X(name, text) [AXIS_CAUSE_##name] = (text),
    INTERPRETER_CAUSES(X)
#undef X
};

void csv_begin_steps(struct outfile *file)
{
    char *at = outfile_reserve(file, LINE_BYTES_MAX);
    at = line_put_string(at, "# tick_hz=");
    at = line_put_unsigned(at, TICK_HZ);
    at = line_put_string(at, "\ntick,motor,position\n");
    outfile_commit(file, at);
}

static char *put_tick_and_motor(char *at, const struct timeline_event *event)
{
    at = line_put_unsigned(at, event->tick);
    *at++ = ',';
    *at++ = (char)('0' + (char)event->motor);
    *at++ = ',';
    return at;
}

void csv_put_step(struct outfile *file, const struct timeline_event *event)
{
    char *at = put_tick_and_motor(outfile_reserve(file, LINE_BYTES_MAX), event);
    at = line_put_signed(at, event->value);
    *at++ = '\n';
    outfile_commit(file, at);
}

void csv_begin_trace(struct outfile *file)
{
    outfile_commit(file, line_put_string(outfile_reserve(file, LINE_BYTES_MAX), "tick,motor,event,value\n"));
}

static char *put_value(char *at, const struct timeline_event *event)
{
    if (event->detail == HAL_TRACE_STOP) {
        return line_put_string(at, stop_texts[event->value]);
    }
    if (event->detail == HAL_TRACE_ERROR) {
        return line_put_string(at, interpreter_error_text((enum interpreter_error)event->value));
    }
    return line_put_signed(at, event->value);
}

void csv_put_trace(struct outfile *file, const struct timeline_event *event)
{
    char *at = put_tick_and_motor(outfile_reserve(file, LINE_BYTES_MAX), event);
    at = line_put_string(at, event_texts[event->detail]);
    *at++ = ',';
    at = put_value(at, event);
    *at++ = '\n';
    outfile_commit(file, at);
}
