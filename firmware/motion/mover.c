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
    *mover = (struct mover){.motor = (uint8_t)motor, .connected = true};
    step_channel_init(&mover->channel, motor);
}

/* Lays the next segment, which takes a Cortex-M4 about 16 us. False if there is none, no room for it now, or a stop
 * that makes it void. */
static bool feed_segment(struct mover *mover)
{
    struct step_segment segment;
    return step_channel_room(&mover->channel) > 0 && motion_plan_next(&mover->plan, &segment) &&
           step_channel_push(&mover->channel, &segment);
}

bool mover_feed(struct mover *mover)
{
    if (!mover_is_moving(mover)) {
        return false;
    }
    hal_run_hold_plan();
    bool fed = feed_segment(mover);
    if (fed && !step_channel_is_running(&mover->channel)) {
        step_channel_run(&mover->channel);
    }
    hal_run_release_plan();
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

/* Of a stop in main and one in the tick interrupt the first counts. */
static bool take_cause(struct mover *mover, enum hal_trace_stop cause, uint64_t tick)
{
    unsigned none = HAL_TRACE_STOP_NONE;
    bool first = atomic_compare_exchange_strong_explicit(&mover->cause, &none, cause, memory_order_relaxed,
                                                         memory_order_relaxed);
    if (first) {
        hal_trace(tick, mover->motor + 1U, HAL_TRACE_STOP, cause);
    }
    return first;
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

/* False if the motor does not move, or is being stopped already. */
static bool stop_move(struct mover *mover, enum hal_trace_stop cause, uint64_t since)
{
    if (!mover_is_moving(mover) || !take_cause(mover, cause, since)) {
        return false;
    }
    if (cause == HAL_TRACE_STOP_LIMIT) {
        step_channel_halt(&mover->channel);
    } else {
        brake(mover, since);
    }
    atomic_store_explicit(&mover->stopping, true, memory_order_release);
    return true;
}

/* All of it is laid at once: main may be held up by the flash for long. */
static void lay_stop(struct mover *mover)
{
    struct step_segment segment;
    struct motion_point point = motion_point_of(&mover->brake, hal_time_now());
    if (motion_plan_stop(&mover->plan, &point) && motion_plan_next(&mover->plan, &segment)) {
        step_channel_splice(&mover->channel, &mover->brake, &segment);
    }
    while (feed_segment(mover)) {
    }
}

/* A motor that was at rest when the stop came, as the planner was late, may have got its next segment since; or else it
 * stays where it is. */
static void plan_stop(struct mover *mover)
{
    if (!mover->braking && mover_stop_cause(mover) != HAL_TRACE_STOP_LIMIT) {
        brake(mover, hal_time_now());
    }
    if (mover->braking) {
        lay_stop(mover);
    } else if (!step_channel_is_running(&mover->channel)) {
        step_channel_halt(&mover->channel);
    }
    mover->braking = false;
}

void mover_plan_isr(struct mover *mover)
{
    if (atomic_exchange_explicit(&mover->stopping, false, memory_order_acquire)) {
        plan_stop(mover);
    }
}

bool mover_sense_isr(struct mover *mover, uint8_t inputs, uint64_t since)
{
    enum hal_trace_stop cause = guard_cause(&mover->guards, inputs);
    atomic_store_explicit(&mover->inputs, inputs, memory_order_relaxed);
    return cause != HAL_TRACE_STOP_NONE && stop_move(mover, cause, since);
}

void mover_stop(struct mover *mover, enum hal_trace_stop cause)
{
    hal_run_hold_plan();
    (void)stop_move(mover, cause, hal_time_now());
    mover_plan_isr(mover);
    hal_run_release_plan();
}

/* An input that changes meanwhile finds the motor standing, and is looked at once more when it moves. */
static void start(struct mover *mover, const struct motion_order *order, uint64_t start_tick)
{
    motion_plan_begin(&mover->plan, order, start_tick);
    for (unsigned i = 0; i < START_SEGMENTS; i++) {
        (void)feed_segment(mover);
    }
    step_channel_run(&mover->channel);
    atomic_store_explicit(&mover->moving, true, memory_order_release);
    enum hal_trace_stop cause = guard_cause(&mover->guards, mover->inputs);
    if (cause != HAL_TRACE_STOP_NONE) {
        (void)stop_move(mover, cause, hal_time_now());
    }
}

void mover_start(struct mover *mover, const struct motion_order *order, bool backward, uint64_t start_tick,
                 const struct mover_guards *guards)
{
    hal_run_hold_plan();
    mover->guards = *guards;
    atomic_store_explicit(&mover->cause, HAL_TRACE_STOP_NONE, memory_order_relaxed);
    step_channel_begin(&mover->channel, (uint32_t)start_tick, backward);
    enum hal_trace_stop cause = guard_cause(guards, mover->inputs);
    if (cause != HAL_TRACE_STOP_NONE) {
        (void)take_cause(mover, cause, start_tick);
    } else {
        start(mover, order, start_tick);
        mover_plan_isr(mover);
    }
    hal_run_release_plan();
}

/* Cuts the plan at the first pulse that leaves time enough, and hands over what follows. Where planning takes longer
 * than the backend said, the motor has gone past that pulse and the next try looks twice as far ahead, up to a second.
 * False if nothing is left to change. */
static bool change_speed(struct mover *mover, uint32_t speed_steps_per_s)
{
    for (uint32_t lead_ticks = hal_step_lead_ticks();
         lead_ticks < TICK_HZ && mover_stop_cause(mover) == HAL_TRACE_STOP_NONE;
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
            mover->plan = plan; /* what the tick interrupt reads for a brake is the same in both */
            return true;
        }
    }
    return false;
}

void mover_change_speed(struct mover *mover, uint32_t speed_steps_per_s)
{
    hal_run_hold_plan();
    if (mover_is_moving(mover) && mover->guards.halt_high == 0 && change_speed(mover, speed_steps_per_s)) {
        hal_trace(hal_time_now(), mover->motor + 1U, HAL_TRACE_SPEED, speed_steps_per_s);
    }
    hal_run_release_plan();
}

/* The step interrupt rests when the queue is empty. If the planner was late there is more: then the motor goes on,
 * late, and the backend counts it. */
void mover_poll(struct mover *mover)
{
    if (!mover_is_moving(mover)) {
        return;
    }
    hal_run_hold_plan();
    if (!step_channel_is_running(&mover->channel)) {
        if (step_channel_room(&mover->channel) < STEP_QUEUE_SEGMENTS || feed_segment(mover)) {
            step_channel_run(&mover->channel);
        } else {
            atomic_store_explicit(&mover->moving, false, memory_order_relaxed);
        }
    }
    hal_run_release_plan();
}

bool mover_is_moving(const struct mover *mover)
{
    return atomic_load_explicit(&mover->moving, memory_order_relaxed);
}

enum hal_trace_stop mover_stop_cause(const struct mover *mover)
{
    return (enum hal_trace_stop)atomic_load_explicit(&mover->cause, memory_order_relaxed);
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

void mover_connect(struct mover *mover, bool connected)
{
    if (connected && !mover->connected) {
        mover_set_position(mover, mover->real_steps);
        hal_step_connect(mover->motor, true);
    } else if (!connected && mover->connected) {
        mover->real_steps = mover_position_steps(mover);
        hal_step_connect(mover->motor, false);
    }
    mover->connected = connected;
}

bool mover_take_mark(struct mover *mover)
{
    return step_channel_take_mark(&mover->channel);
}

unsigned mover_corners(const struct mover *mover, struct motion_corner corners[MOTION_CORNERS_MAX])
{
    if (!mover_is_moving(mover)) {
        return 0;
    }
    hal_run_hold_plan();
    unsigned count = motion_plan_corners(&mover->plan, corners);
    hal_run_release_plan();
    return count;
}

bool mover_pulse_isr(struct mover *mover)
{
    return step_channel_pulse_isr(&mover->channel);
}
