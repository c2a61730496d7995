#include "axis_private.h"
#include "hal_run.h"
#include "hal_time.h"
#include "hal_trace.h"

enum axis_cause axis_guarded_cause(const struct axis *axis)
{
    const struct axis_guards *guards = &axis->guards;
    unsigned inputs = atomic_load_explicit(&axis->inputs, memory_order_relaxed);
    if ((guards->abort_high & inputs) != 0) {
        return AXIS_CAUSE_ABORT;
    }
    if ((guards->stop_high & inputs) != 0) {
        return AXIS_CAUSE_HIGH;
    }
    if ((guards->stop_low & ~inputs) != 0) {
        return AXIS_CAUSE_LOW;
    }
    return (guards->halt_high & inputs) != 0 ? AXIS_CAUSE_LIMIT : AXIS_CAUSE_NONE;
}

void axis_set_cause(struct axis *axis, enum axis_cause cause, uint64_t tick)
{
    atomic_store_explicit(&axis->cause, cause, memory_order_relaxed);
    hal_trace(tick, axis->motor + 1U, HAL_TRACE_STOP, cause);
}

/* At high rates there is no time for planning before the next pulse. A pulse that came after `since` is the one to
 * brake from, although the next is armed by now. Nothing at rest, where the planner is late. */
static void brake(struct axis *axis, uint64_t since)
{
    struct step_cursor *at = &axis->brake_from;
    struct motion_brake brake;
    if (step_channel_find_pulse(&axis->channel, (uint32_t)since, at) &&
        motion_plan_brake(&axis->plan, step_cursor_pulse(at), at->generator.slope, &brake)) {
        (void)step_channel_brake(&axis->channel, brake.accel, brake.until, at);
    }
}

bool axis_stop_since(struct axis *axis, enum axis_cause cause, uint64_t since)
{
    bool halt = cause == AXIS_CAUSE_LIMIT;
    if (!axis_enter(axis, halt ? AXIS_HALT : AXIS_STOP)) {
        return false;
    }
    axis_set_cause(axis, cause, since);
    if (halt) {
        step_channel_halt(&axis->channel);
    } else {
        brake(axis, since);
    }
    return true;
}

/* All of it is planned at once: main may be held up by the flash for long. */
static void plan_way_down(struct axis *axis)
{
    struct step_segment segment;
    struct motion_point point = motion_point_of(&axis->brake_from, hal_time_now());
    if (motion_plan_stop(&axis->plan, &point) && motion_plan_next(&axis->plan, &segment)) {
        step_channel_replace_brake(&axis->channel, &axis->brake_from, &segment);
    }
    while (axis_feed_segment(axis)) {
    }
}

/* A motor that was at rest when the stop came, as the planner was late, may have got its next segment since; or else it
 * stays where it is. One that is about to make its last pulse makes it. */
static void plan_stop(struct axis *axis)
{
    if (!axis->channel.closed) {
        brake(axis, hal_time_now());
    }
    if (axis->channel.closed) {
        plan_way_down(axis);
    } else if (!step_channel_is_running(&axis->channel)) {
        step_channel_halt(&axis->channel);
    }
}

void axis_plan_isr(struct axis *axis)
{
    if (axis_enter(axis, AXIS_PLANNED)) {
        plan_stop(axis);
    }
}

bool axis_sense_isr(struct axis *axis, uint8_t inputs, uint64_t since)
{
    atomic_store_explicit(&axis->inputs, inputs, memory_order_relaxed);
    enum axis_cause cause = axis_guarded_cause(axis);
    return cause != AXIS_CAUSE_NONE && axis_stop_since(axis, cause, since);
}

bool axis_stop(struct axis *axis, enum axis_cause cause)
{
    hal_run_hold_plan();
    bool stopped = axis_stop_since(axis, cause, hal_time_now());
    axis_plan_isr(axis);
    hal_run_release_plan();
    return stopped;
}
