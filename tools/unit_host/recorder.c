#include "recorder.h"

#include "csv.h"
#include "host_machine.h"

static void recorder_write(void *context, const struct timeline_event *event)
{
    struct recorder *recorder = context;
    if (event->kind == TIMELINE_STEP && outfile_is_open(&recorder->steps)) {
        csv_put_step(&recorder->steps, event);
    }
    if (event->kind == TIMELINE_TRACE && outfile_is_open(&recorder->trace)) {
        csv_put_trace(&recorder->trace, event, recorder->kind);
    }
    if (event->kind == TIMELINE_POSITION && recorder->kind->traces_positions && outfile_is_open(&recorder->trace)) {
        csv_put_position(&recorder->trace, event);
    }
    if (outfile_is_open(&recorder->waves)) {
        waves_put(&recorder->drawing, event);
    }
}

static bool recorder_begin(struct recorder *recorder, const struct curve_range *range)
{
    if (outfile_is_open(&recorder->steps)) {
        csv_begin_steps(&recorder->steps);
    }
    if (outfile_is_open(&recorder->trace)) {
        csv_begin_trace(&recorder->trace);
    }
    if (outfile_is_open(&recorder->waves)) {
        waves_begin(&recorder->drawing, &recorder->waves, recorder->kind);
    }
    return !outfile_is_open(&recorder->line) || curve_begin(&recorder->curve, &recorder->line, range);
}

bool recorder_open(struct recorder *recorder, const struct recorder_paths *paths, const struct unit_kind *kind)
{
    recorder->kind = kind;
    timeline_init(&recorder->timeline, recorder_write, recorder);
    recorder->sorts = paths->steps != NULL || paths->trace != NULL || paths->vcd != NULL;
    recorder->active = recorder->sorts || paths->curve != NULL;
    recorder->steps = (struct outfile){.path = NULL};
    recorder->trace = recorder->steps;
    recorder->waves = recorder->steps;
    recorder->line = recorder->steps;
    recorder->curve = (struct curve){.outputs = NULL};
    if (!outfile_open(&recorder->steps, paths->steps) || !outfile_open(&recorder->trace, paths->trace) ||
        !outfile_open(&recorder->waves, paths->vcd) || !outfile_open(&recorder->line, paths->curve) ||
        !recorder_begin(recorder, &paths->range)) {
        recorder_discard(recorder);
        return false;
    }
    return true;
}

void recorder_put(struct recorder *recorder, const struct timeline_event *event, uint64_t now_ticks)
{
    if (outfile_is_open(&recorder->line)) {
        curve_put(&recorder->curve, event);
    }
    if (!recorder->sorts) {
        return;
    }
    timeline_put(&recorder->timeline, event, now_ticks);
    if (event->kind == TIMELINE_STEP && outfile_is_open(&recorder->waves)) {
        struct timeline_event fall = *event;
        fall.kind = TIMELINE_STEP_END;
        fall.tick += HOST_PULSE_TICKS;
        timeline_put(&recorder->timeline, &fall, now_ticks);
    }
}

void recorder_put_command(struct recorder *recorder, uint64_t tick, unsigned motor, int64_t ordinal)
{
    if (outfile_is_open(&recorder->line)) {
        curve_put_command(&recorder->curve, motor - 1U, tick, ordinal);
    }
}

bool recorder_finish(struct recorder *recorder, uint64_t end_tick)
{
    timeline_flush(&recorder->timeline);
    if (outfile_is_open(&recorder->waves)) {
        waves_end(&recorder->drawing, end_tick);
    }
    if (outfile_is_open(&recorder->line)) {
        curve_end(&recorder->curve, end_tick);
    }
    bool good = outfile_close(&recorder->steps);
    good = outfile_close(&recorder->trace) && good;
    good = outfile_close(&recorder->waves) && good;
    good = outfile_close(&recorder->line) && good;
    good = good && outfile_publish(&recorder->steps) && outfile_publish(&recorder->trace) &&
           outfile_publish(&recorder->waves) && outfile_publish(&recorder->line);
    recorder_discard(recorder);
    return good;
}

void recorder_discard(struct recorder *recorder)
{
    outfile_discard(&recorder->steps);
    outfile_discard(&recorder->trace);
    outfile_discard(&recorder->waves);
    outfile_discard(&recorder->line);
    curve_discard(&recorder->curve);
    recorder->active = false;
}
