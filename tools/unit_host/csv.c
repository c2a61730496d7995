#include "csv.h"

#include "hal_trace.h"
#include "line.h"

enum {
    LINE_BYTES_MAX = 256
};

static const char *const event_texts[] = {
#define X(name, text) text,
    HAL_TRACE_EVENTS(X)
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

void csv_put_position(struct outfile *file, const struct timeline_event *event)
{
    char *at = put_tick_and_motor(outfile_reserve(file, LINE_BYTES_MAX), event);
    at = line_put_string(at, "position,");
    at = line_put_signed(at, event->value);
    *at++ = '\n';
    outfile_commit(file, at);
}

void csv_put_trace(struct outfile *file, const struct timeline_event *event, const struct unit_kind *kind)
{
    const char *text = kind->trace_text((enum hal_trace_event)event->detail, event->value);
    char *at = put_tick_and_motor(outfile_reserve(file, LINE_BYTES_MAX), event);
    at = line_put_string(at, event_texts[event->detail]);
    *at++ = ',';
    at = text != NULL ? line_put_string(at, text) : line_put_signed(at, event->value);
    *at++ = '\n';
    outfile_commit(file, at);
}
