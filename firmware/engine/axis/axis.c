#include "axis.h"

#include <assert.h>

#include "axis_private.h"
#include "base_tick.h"
#include "hal_driver.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_time.h"
#include "hal_trace.h"

enum {
    START_SEGMENTS = 1,  /* planned before a start: four motors must start in time for their first steps */
    CHANGE_SEGMENTS = 2, /* handed over with a change; they must last while the others are planned */
};

bool axis_enter(struct axis *axis, enum axis_event event)
{
    return axis_state_enter(&axis->state, event);
}

void axis_init(struct axis *axis, unsigned motor)
{
    *axis = (struct axis){.motor = (uint8_t)motor, .state = AXIS_STANDING};
    step_channel_init(&axis->channel, motor);
}

bool axis_feed_segment(struct axis *axis)
{
    struct step_segment segment;
    return step_channel_room(&axis->channel) > 0 && motion_plan_next(&axis->plan, &segment) &&
           step_channel_push(&axis->channel, &segment);
}

bool axis_feed(struct axis *axis)
{
    if (!axis_is_moving(axis)) {
        return false;
    }
    hal_run_hold_plan();
    bool fed = axis_feed_segment(axis);
    if (fed && !step_channel_is_running(&axis->channel)) {
        step_channel_run(&axis->channel);
    }
    hal_run_release_plan();
    return fed;
}

static uint64_t order_steps(const struct motion_order *order)
{
    uint64_t steps = 0;
    for (unsigned i = 0; i < order->sections; i++) {
        steps += order->section[i].steps;
    }
    return steps;
}

static int64_t signed_steps(const struct axis *axis, uint64_t steps)
{
    return axis->channel.direction * (int64_t)steps;
}

/* An input that changes meanwhile finds the motor standing, and is looked at once more when it moves. */
static void start(struct axis *axis, uint64_t start_tick)
{
    hal_driver_enable();
    motion_plan_begin(&axis->plan, &axis->order, start_tick);
    for (unsigned i = 0; i < START_SEGMENTS; i++) {
        (void)axis_feed_segment(axis);
    }
    step_channel_run(&axis->channel);
    (void)axis_enter(axis, AXIS_BEGIN);
    enum axis_cause cause = axis_guarded_cause(axis);
    if (cause != AXIS_CAUSE_NONE) {
        (void)axis_stop_since(axis, cause, hal_time_now());
    }
}

/* Begins the order. */
static void begin(struct axis *axis, bool backward, uint64_t start_tick)
{
    assert(!axis_is_busy(axis));
    hal_run_hold_plan();
    step_channel_begin(&axis->channel, (uint32_t)start_tick, backward);
    uint64_t steps = motion_order_is_endless(&axis->order) ? 0 : order_steps(&axis->order);
    hal_trace(start_tick, axis->motor + 1U, HAL_TRACE_MOVE, signed_steps(axis, steps));
    atomic_store_explicit(&axis->cause, AXIS_CAUSE_NONE, memory_order_relaxed);
    enum axis_cause cause = axis_guarded_cause(axis);
    if (cause != AXIS_CAUSE_NONE) {
        (void)axis_enter(axis, AXIS_REFUSE);
        axis_set_cause(axis, cause, start_tick);
    } else {
        start(axis, start_tick);
        axis_plan_isr(axis);
    }
    axis->marked = axis->order.sections == 1 && axis_cause(axis) == AXIS_CAUSE_NONE;
    hal_run_release_plan();
}

void axis_begin(struct axis *axis, const struct motion_order *order, bool backward, uint64_t start_tick,
                const struct axis_guards *guards)
{
    axis->order = *order;
    axis->guards = *guards;
    begin(axis, backward, start_tick);
}

bool axis_has_rest(const struct axis *axis)
{
    return axis->order.sections > 0;
}

void axis_forget(struct axis *axis)
{
    axis->order.sections = 0;
}

bool axis_is_jog(const struct axis *axis)
{
    return motion_order_is_endless(&axis->order) && axis->guards.halt_high == 0;
}

void axis_go_on(struct axis *axis, uint64_t start_tick)
{
    begin(axis, axis->channel.direction < 0, start_tick);
}

/* Replaces the plan from the first pulse that leaves time enough. Where planning takes longer than the backend said,
 * the motor has gone past that pulse and the next try looks twice as far ahead, up to a second. False if nothing is
 * left to change. */
static bool change_speed(struct axis *axis, uint32_t speed_steps_per_s)
{
    for (uint32_t lead_ticks = hal_step_lead_ticks(); lead_ticks < TICK_HZ && axis_cause(axis) == AXIS_CAUSE_NONE;
         lead_ticks = 2U * lead_ticks + TICKS_PER_US) {
        uint64_t now = hal_time_now();
        struct step_cursor at;
        struct step_segment segments[CHANGE_SEGMENTS];
        struct motion_plan plan = axis->plan;
        if (!step_channel_look_ahead(&axis->channel, (uint32_t)now + lead_ticks, &at)) {
            return false;
        }
        struct motion_point point = motion_point_of(&at, now);
        if (!motion_plan_change_speed(&plan, &point, speed_steps_per_s)) {
            return false;
        }
        unsigned count = 0;
        while (count < CHANGE_SEGMENTS && motion_plan_next(&plan, &segments[count])) {
            count++;
        }
        if (step_channel_replace(&axis->channel, &at, segments, count)) {
            axis->plan = plan; /* what the tick interrupt reads for a brake is the same in both */
            return true;
        }
    }
    return false;
}

void axis_change_speed(struct axis *axis, uint32_t speed_steps_per_s)
{
    hal_run_hold_plan();
    if (axis_is_moving(axis) && axis->guards.halt_high == 0 && change_speed(axis, speed_steps_per_s)) {
        hal_trace(hal_time_now(), axis->motor + 1U, HAL_TRACE_SPEED, speed_steps_per_s);
    }
    hal_run_release_plan();
}

/* A stop of the tick interrupt in just this moment is told as the cause, and there is nothing left to stop. */
static void end(struct axis *axis)
{
    while (!axis_enter(axis, AXIS_LAST)) {
    }
}

/* The step interrupt rests when the queue is empty. If the planner was late there is more: then the motor goes on,
 * late, and the backend counts it. */
void axis_poll(struct axis *axis)
{
    if (!axis_is_moving(axis)) {
        return;
    }
    hal_run_hold_plan();
    if (!step_channel_is_running(&axis->channel)) {
        if (step_channel_room(&axis->channel) < STEP_QUEUE_SEGMENTS || axis_feed_segment(axis)) {
            step_channel_run(&axis->channel);
        } else {
            end(axis);
        }
    }
    hal_run_release_plan();
}

/* Takes the steps that were made off the order; no section is left if that was all. A run without end stays one. */
static void take_off_made(struct motion_order *order, uint64_t steps_made)
{
    unsigned done = 0;
    if (motion_order_is_endless(order)) {
        return;
    }
    while (done < order->sections && steps_made >= order->section[done].steps) {
        steps_made -= order->section[done].steps;
        done++;
    }
    order->sections = (uint8_t)(order->sections - done);
    for (unsigned i = 0; i < order->sections; i++) {
        order->section[i] = order->section[i + done];
    }
    order->section[0].steps -= steps_made;
}

bool axis_take_end(struct axis *axis)
{
    if (!axis_enter(axis, AXIS_TAKE)) {
        return false;
    }
    uint64_t made = axis_steps_made(axis);
    hal_trace(axis_end_tick(axis), axis->motor + 1U, HAL_TRACE_DONE, signed_steps(axis, made));
    take_off_made(&axis->order, made);
    return true;
}

enum axis_cause axis_cause(const struct axis *axis)
{
    return (enum axis_cause)atomic_load_explicit(&axis->cause, memory_order_relaxed);
}

uint64_t axis_end_tick(const struct axis *axis)
{
    return tick_extend(step_channel_end_tick(&axis->channel), hal_time_now());
}

uint64_t axis_steps_made(const struct axis *axis)
{
    return step_channel_pulses(&axis->channel);
}

int64_t axis_position_steps(const struct axis *axis)
{
    return step_channel_position(&axis->channel);
}

void axis_set_position(struct axis *axis, int64_t position_steps)
{
    step_channel_set_position(&axis->channel, position_steps);
}

void axis_simulate(struct axis *axis, bool simulated)
{
    if (axis_is_moving(axis) || simulated == axis->simulated) {
        return;
    }
    if (simulated) {
        axis->real_steps = axis_position_steps(axis);
    } else {
        axis_set_position(axis, axis->real_steps);
    }
    hal_step_connect(axis->motor, !simulated);
    axis->simulated = simulated;
}

bool axis_is_simulated(const struct axis *axis)
{
    return axis->simulated;
}

bool axis_take_mark(struct axis *axis)
{
    bool marked = step_channel_take_mark(&axis->channel) || axis->marked;
    axis->marked = false;
    return marked;
}

unsigned axis_corners(const struct axis *axis, struct motion_corner corners[MOTION_CORNERS_MAX])
{
    if (!axis_is_moving(axis)) {
        return 0;
    }
    hal_run_hold_plan();
    unsigned count = motion_corners_of(&axis->plan, corners);
    hal_run_release_plan();
    return count;
}
