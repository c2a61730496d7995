#include "mover.h"

#include "base_tick.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_time.h"

enum {
    START_SEGMENTS = 1, /* laid before the first pulse is armed: four motors must start in time for their first steps */
    CUT_SEGMENTS = 2,   /* handed over with a cut; they must last while the others are laid */
};

void mover_init(struct mover *mover, unsigned motor)
{
    *mover = (struct mover){.motor = (uint8_t)motor};
    step_channel_init(&mover->channel, motor);
}

/* Lays the next segment, which takes a Cortex-M4 about 16 us. False if there is none, or no room for it now. */
static bool feed_segment(struct mover *mover)
{
    struct step_segment segment;
    bool fed = step_channel_room(&mover->channel) > 0 && motion_plan_next(&mover->plan, &segment);
    if (fed) {
        step_channel_push(&mover->channel, &segment);
    }
    return fed;
}

bool mover_feed(struct mover *mover)
{
    if (!mover->moving) {
        return false;
    }
    hal_run_hold_tick();
    bool fed = feed_segment(mover);
    if (fed && !step_channel_is_running(&mover->channel)) {
        step_channel_run(&mover->channel);
    }
    hal_run_release_tick();
    return fed;
}

static enum hal_trace_stop guard_cause(const struct mover_guards *guards, uint8_t inputs)
{
    if ((guards->stop_total & inputs) != 0) {
        return HAL_TRACE_STOP_TOTAL;
    }
    if ((guards->stop_high & inputs) != 0) {
        return HAL_TRACE_STOP_HIGH;
    }
    if ((guards->stop_low & ~(unsigned)inputs) != 0) {
        return HAL_TRACE_STOP_LOW;
    }
    return (guards->halt_high & inputs) != 0 ? HAL_TRACE_STOP_LIMIT : HAL_TRACE_STOP_NONE;
}

static void set_cause(struct mover *mover, enum hal_trace_stop cause, uint64_t tick)
{
    mover->cause = cause;
    hal_trace(tick, mover->motor + 1U, HAL_TRACE_STOP, cause);
}

void mover_start(struct mover *mover, const struct motion_order *order, bool backward, uint64_t start_tick,
                 const struct mover_guards *guards, uint8_t inputs)
{
    hal_run_hold_tick();
    mover->guards = *guards;
    mover->cause = HAL_TRACE_STOP_NONE;
    step_channel_begin(&mover->channel, (uint32_t)start_tick, backward);
    enum hal_trace_stop cause = guard_cause(guards, inputs);
    if (cause != HAL_TRACE_STOP_NONE) {
        set_cause(mover, cause, start_tick);
    } else {
        motion_plan_begin(&mover->plan, order, start_tick);
        mover->braking = false;
        for (unsigned i = 0; i < START_SEGMENTS; i++) {
            (void)feed_segment(mover);
        }
        mover->moving = true;
        step_channel_run(&mover->channel);
    }
    hal_run_release_tick();
}

/* Cuts the plan at the first pulse that leaves time enough, and hands over what follows. Where planning takes longer
 * than the backend said, the motor has gone past that pulse and the next try looks twice as far ahead, up to a second.
 * False if nothing is left to change. */
static bool change_speed(struct mover *mover, uint32_t speed_steps_per_s)
{
    for (uint32_t lead_ticks = hal_step_lead_ticks(); lead_ticks < TICK_HZ;
         lead_ticks = 2U * lead_ticks + TICKS_PER_US) {
        uint64_t now = hal_time_now();
        struct step_cursor at;
        struct step_segment segments[CUT_SEGMENTS];
        struct motion_plan plan = mover->plan;
        if (!step_channel_foresee(&mover->channel, (uint32_t)now + lead_ticks, &at)) {
            return false;
        }
        struct motion_point point = motion_point_of(&at, now);
        if (!motion_plan_change_speed(&plan, &point, speed_steps_per_s)) {
            return false;
        }
        unsigned count = 0;
        while (count < CUT_SEGMENTS && motion_plan_next(&plan, &segments[count])) {
            count++;
        }
        if (step_channel_cut(&mover->channel, &at, segments, count)) {
            mover->plan = plan;
            return true;
        }
    }
    return false;
}

/* Brakes at once: at high rates there is no time for planning before the next pulse. A pulse that came after `since` is
 * the one to brake from, although the next is armed by now. */
static void brake(struct mover *mover, uint64_t since)
{
    struct step_cursor *at = &mover->brake;
    struct motion_brake brake;
    if (step_channel_look(&mover->channel, (uint32_t)since, at) &&
        motion_plan_brake(&mover->plan, step_cursor_pulse(at), at->generator.slope, &brake)) {
        mover->braking = step_channel_brake(&mover->channel, brake.accel, brake.until, at);
    }
}

/* All of it is laid at once: main may be held up by the flash for long. */
static void plan_stop(struct mover *mover)
{
    struct step_segment segment;
    struct motion_point point = motion_point_of(&mover->brake, hal_time_now());
    mover->braking = false;
    if (motion_plan_stop(&mover->plan, &point) && motion_plan_next(&mover->plan, &segment)) {
        step_channel_splice(&mover->channel, &mover->brake, &segment);
    }
    while (feed_segment(mover)) {
    }
}

static void stop_locked(struct mover *mover, enum hal_trace_stop cause, uint64_t since)
{
    if (!mover->moving || mover->cause != HAL_TRACE_STOP_NONE) {
        return;
    }
    set_cause(mover, cause, since);
    if (cause == HAL_TRACE_STOP_LIMIT) {
        motion_plan_end(&mover->plan);
        step_channel_halt(&mover->channel);
    } else {
        brake(mover, since);
    }
}

void mover_stop(struct mover *mover, enum hal_trace_stop cause)
{
    hal_run_hold_tick();
    stop_locked(mover, cause, hal_time_now());
    mover_plan_stop_isr(mover);
    hal_run_release_tick();
}

void mover_change_speed(struct mover *mover, uint32_t speed_steps_per_s)
{
    hal_run_hold_tick();
    bool changeable = mover->moving && mover->cause == HAL_TRACE_STOP_NONE && mover->guards.halt_high == 0;
    if (changeable && change_speed(mover, speed_steps_per_s)) {
        hal_trace(hal_time_now(), mover->motor + 1U, HAL_TRACE_SPEED, speed_steps_per_s);
    }
    hal_run_release_tick();
}

/* The step interrupt rests when the queue is empty. If the planner was late there is more: then the motor goes on,
 * late, and the backend counts it. */
void mover_poll(struct mover *mover)
{
    if (!mover->moving) {
        return;
    }
    hal_run_hold_tick();
    if (!step_channel_is_running(&mover->channel)) {
        if (step_channel_room(&mover->channel) < STEP_QUEUE_SEGMENTS || feed_segment(mover)) {
            step_channel_run(&mover->channel);
        } else {
            mover->moving = false;
        }
    }
    hal_run_release_tick();
}

bool mover_is_moving(const struct mover *mover)
{
    return mover->moving;
}

enum hal_trace_stop mover_stop_cause(const struct mover *mover)
{
    return mover->cause;
}

uint64_t mover_end_tick(const struct mover *mover)
{
    return tick_extend(step_channel_end_tick(&mover->channel), hal_time_now());
}

uint64_t mover_steps_made(const struct mover *mover)
{
    return step_channel_pulses(&mover->channel);
}

int64_t mover_position_steps(const struct mover *mover)
{
    return step_channel_position(&mover->channel);
}

void mover_set_position(struct mover *mover, int64_t position_steps)
{
    step_channel_set_position(&mover->channel, position_steps);
}

bool mover_take_mark(struct mover *mover)
{
    return step_channel_take_mark(&mover->channel);
}

unsigned mover_corners(const struct mover *mover, struct motion_corner corners[MOTION_CORNERS_MAX])
{
    if (!mover->moving) {
        return 0;
    }
    hal_run_hold_tick();
    unsigned count = motion_plan_corners(&mover->plan, corners);
    hal_run_release_tick();
    return count;
}

bool mover_sense_isr(struct mover *mover, uint8_t inputs, uint64_t since)
{
    enum hal_trace_stop cause = guard_cause(&mover->guards, inputs);
    bool stops = mover->moving && mover->cause == HAL_TRACE_STOP_NONE && cause != HAL_TRACE_STOP_NONE;
    if (stops) {
        stop_locked(mover, cause, since);
    }
    return stops;
}

void mover_plan_stop_isr(struct mover *mover)
{
    if (mover->braking) {
        plan_stop(mover);
    }
}

bool mover_pulse_isr(struct mover *mover)
{
    return step_channel_pulse_isr(&mover->channel);
}
