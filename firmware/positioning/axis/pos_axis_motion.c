#include "pos_axis_private.h"

#include "base_tick.h"
#include "hal_step.h"
#include "hal_time.h"
#include "hal_trace.h"

/* ---- positions ------------------------------------------------------------------------------------------------- */

static void note_capture(struct pos_axis *axis, int64_t motor_steps)
{
    axis->captured_step = pos_frame_step_of(&axis->frame, motor_steps);
    axis->captured_um = pos_frame_position_um(&axis->frame, axis->captured_step);
    axis->captures++;
}

/* What an input has kept is of a moment since the last look, so it comes before the frame goes on. */
void pos_axis_look(struct pos_axis *axis)
{
    hal_step_hold();
    bool captured = axis->watch.captured;
    axis->watch.captured = false;
    int64_t captured_motor_steps = axis->watch.captured_motor_steps;
    int64_t reference_motor_steps = axis->watch.reference_motor_steps;
    bool found = axis->watch.reference_hit;
    int64_t motor_steps = pos_drive_steps_held(&axis->drive);
    hal_step_release();
    if (captured) {
        note_capture(axis, captured_motor_steps);
    }
    if (found && !axis->found) {
        axis->found = true;
        axis->reference_step = pos_frame_step_of(&axis->frame, reference_motor_steps);
    }
    pos_frame_follow(&axis->frame, motor_steps);
}

/* ---- onlookers ------------------------------------------------------------------------------------------------- */

static void tell(const struct pos_axis *axis, uint64_t tick, enum hal_trace_event event, int64_t value)
{
    hal_trace(tick, axis->drive.motor + 1U, event, value);
}

static void tell_begin(struct pos_axis *axis, uint64_t tick)
{
    int64_t left = (int64_t)pos_drive_left(&axis->drive);
    axis->motion_steps = pos_drive_steps(&axis->drive);
    tell(axis, tick, HAL_TRACE_MOVE, axis->negative ? -left : left);
}

static void tell_end(const struct pos_axis *axis)
{
    tell(axis, pos_drive_end_tick(&axis->drive), HAL_TRACE_DONE, pos_drive_steps(&axis->drive) - axis->motion_steps);
}

static void tell_speed(const struct pos_axis *axis)
{
    tell(axis, hal_time_now(), HAL_TRACE_SPEED, (int64_t)(axis->speed / PATH_SPEED_UNITS));
}

static void hold(struct pos_axis *axis)
{
    tell(axis, hal_time_now(), HAL_TRACE_STOP, AXIS_CAUSE_PAUSE);
    pos_drive_hold(&axis->drive);
}

/* ---- measures -------------------------------------------------------------------------------------------------- */

static uint32_t accel_of(const struct pos_axis *axis, uint32_t accel_mm_s2)
{
    uint32_t highest_mm_s2 = pos_axis_setting(axis, POS_AXIS_HIGHEST_ACCEL);
    uint32_t accel = accel_mm_s2 < highest_mm_s2 ? accel_mm_s2 : highest_mm_s2;
    return pos_measure_accel(&axis->frame.scale, accel, PATH_ACCEL_MAX);
}

static uint32_t speed_of(const struct pos_axis *axis, uint32_t feed)
{
    uint32_t highest = pos_axis_setting(axis, POS_AXIS_HIGHEST_FEED);
    return pos_measure_speed(&axis->frame.scale, feed < highest ? feed : highest, POS_SPEED_MAX);
}

/* Whether W of unit.md is not 0. */
static bool is_wanted(const struct pos_axis *axis)
{
    return ((unsigned)axis->control->control2 & (unsigned)POS_CNT_MP) != 0U && axis->feed != 0U;
}

/* W as a speed. */
static uint32_t wanted_speed(struct pos_axis *axis)
{
    if (!is_wanted(axis)) {
        return 0;
    }
    uint32_t feed = axis->feed;
    if (axis->phase != (uint8_t)POS_PHASE_NONE) {
        uint32_t most = pos_home_feed(axis);
        feed = feed < most ? feed : most;
    }
    if (feed != axis->feed_of_speed) {
        axis->feed_of_speed = feed;
        axis->speed_of_feed = speed_of(axis, feed);
    }
    return axis->speed_of_feed;
}

bool pos_axis_aim(struct pos_axis *axis, int64_t step)
{
    struct pos_way way = pos_frame_way(&axis->frame, pos_drive_steps(&axis->drive), step);
    if (way.pulses == 0U) {
        return false;
    }
    const struct pos_measure measure = {
        .pulses = way.pulses,
        .accel = accel_of(axis, axis->order.accel_mm_s2),
        .fault_accel = accel_of(axis, pos_axis_setting(axis, POS_AXIS_ERROR_ACCEL)),
        .start_speed = speed_of(axis, pos_axis_setting(axis, POS_AXIS_START_FEED)),
        .backward = way.backward,
    };
    pos_drive_aim(&axis->drive, &measure);
    pos_axis_mark(axis, POS_CNT_CONT, 0);
    return true;
}

void pos_axis_reached(struct pos_axis *axis)
{
    axis->state = (uint8_t)POS_REACHED;
    axis->phase = (uint8_t)POS_PHASE_NONE;
    pos_axis_mark(axis, 0, POS_CNT_CONT);
}

static void clear_watch(struct pos_axis *axis)
{
    hal_step_hold();
    axis->watch.seek = (uint8_t)POS_SEEK_NOTHING;
    axis->watch.reference_hit = false;
    hal_step_release();
    axis->found = false;
}

void pos_axis_drop(struct pos_axis *axis)
{
    axis->phase = (uint8_t)POS_PHASE_NONE;
    axis->waits = false;
    axis->feed = 0;
    pos_axis_mark(axis, 0, (unsigned)POS_CNT_INIC | (unsigned)POS_CNT_CONT);
    clear_watch(axis);
}

void pos_axis_give_up(struct pos_axis *axis, bool fault)
{
    pos_axis_drop(axis);
    if (!pos_axis_is_busy(axis)) {
        pos_frame_give_up(&axis->frame);
    } else if (fault) {
        tell(axis, hal_time_now(), HAL_TRACE_STOP, AXIS_CAUSE_FAULT);
        pos_drive_fault(&axis->drive);
    } else {
        hold(axis);
    }
}

/* Whether the limits of a measure act. */
static void limit(struct pos_axis *axis)
{
    int32_t min_um = pos_axis_signed_setting(axis, POS_AXIS_SOFT_MIN);
    int32_t max_um = pos_axis_signed_setting(axis, POS_AXIS_SOFT_MAX);
    if (axis->frame.referenced && min_um < max_um) {
        pos_frame_limit(&axis->frame, &axis->target, min_um, max_um);
    }
}

static void end_measure(struct pos_axis *axis)
{
    if (axis->target.cut) {
        pos_axis_fault(axis, POS_ERROR_SOFT);
    } else {
        pos_frame_reach(&axis->frame, &axis->target);
        pos_axis_reached(axis);
    }
}

static void begin_measure(struct pos_axis *axis)
{
    if (axis->order.kind == (uint8_t)POS_KIND_WAY) {
        pos_frame_aim(&axis->frame, axis->order.len_um, &axis->target);
    } else {
        pos_frame_aim_at(&axis->frame, axis->order.len_um, &axis->target);
    }
    limit(axis);
    if (!pos_axis_aim(axis, axis->target.step)) {
        end_measure(axis);
    }
}

/* The initiator: the axis stands. What a measure before has left is dropped. */
static void initiate(struct pos_axis *axis)
{
    axis->waits = false;
    axis->state = (uint8_t)POS_READY;
    pos_axis_mark(axis, 0, POS_CNT_INIC);
    pos_frame_give_up(&axis->frame);
    if (axis->order.kind == (uint8_t)POS_KIND_HOME) {
        pos_home_prepare(axis);
    } else {
        begin_measure(axis);
    }
}

/* ---- a pass ---------------------------------------------------------------------------------------------------- */

/* The motor has come to rest. */
static void end(struct pos_axis *axis, uint8_t inputs)
{
    tell_end(axis);
    if (axis->state != (uint8_t)POS_MOVING) {
        pos_frame_give_up(&axis->frame);
        return;
    }
    bool left = pos_drive_left(&axis->drive) != 0U;
    if (axis->phase != (uint8_t)POS_PHASE_NONE && (axis->found || !left)) {
        pos_home_follow(axis, inputs);
    } else if (!left) {
        end_measure(axis);
    } else {
        axis->state = (uint8_t)POS_READY;
    }
}

/* The switch may be found just as the axis leaves a stand: its stop found nothing to stop. */
static void stop_at_switch(struct pos_axis *axis)
{
    hal_step_hold();
    bool found = axis->watch.reference_hit;
    hal_step_release();
    if (found) {
        hold(axis);
    }
}

/* A stop that cannot be taken back any more comes to its end first, and so does one at the switch, which may be found
 * just in this moment. */
static void resume(struct pos_axis *axis, uint32_t speed)
{
    if (axis->found || !pos_drive_resume(&axis->drive, speed)) {
        return;
    }
    axis->speed = speed;
    tell_speed(axis);
    stop_at_switch(axis);
}

static enum pos_axis_register limit_of(const struct pos_axis *axis)
{
    return axis->drive.measure.backward ? POS_AXIS_LIMIT_MINUS : POS_AXIS_LIMIT_PLUS;
}

/* The limit input that acts on the way that the drive has; 0: none. In homing not the one that is the reference, too.
 */
static int8_t limit_input(const struct pos_axis *axis)
{
    int32_t input = pos_axis_signed_setting(axis, limit_of(axis));
    int32_t reference = pos_axis_signed_setting(axis, POS_AXIS_REFERENCE);
    bool same = input == reference || input == -reference;
    int32_t acts = axis->phase != (uint8_t)POS_PHASE_NONE && same ? 0 : input;
    return (int8_t)acts;
}

static void take_limit(struct pos_axis *axis)
{
    hal_step_hold();
    bool hit = axis->watch.limit_hit;
    axis->watch.limit_hit = false;
    hal_step_release();
    if (hit) {
        pos_axis_fault(axis, POS_ERROR_LIMIT);
    }
}

uint64_t pos_axis_poll(struct pos_axis *axis, uint8_t inputs)
{
    pos_axis_mark(axis, 0, POS_CNT_RESET);
    uint64_t wake = pos_drive_poll(&axis->drive);
    bool ended = pos_drive_take_end(&axis->drive);
    bool happened = atomic_exchange_explicit(&axis->watch.happened, false, memory_order_relaxed);
    if (ended || happened) {
        pos_axis_look(axis);
        take_limit(axis);
    }
    if (ended) {
        end(axis, inputs);
        wake = hal_time_now();
    }
    if (axis->found && !pos_axis_is_busy(axis)) {
        pos_home_follow(axis, inputs); /* the switch has changed in a hold */
    }
    if (axis->waits && !pos_axis_is_busy(axis)) {
        initiate(axis);
    }
    return wake;
}

static void follow(struct pos_axis *axis)
{
    uint32_t speed = wanted_speed(axis);
    if (!pos_axis_is_busy(axis)) {
        axis->state = (uint8_t)(speed == 0U ? POS_READY : POS_MOVING); /* between two parts of homing */
    } else if (speed == axis->speed) {
        /* it stays */
    } else if (speed == 0U) {
        hold(axis);
        axis->speed = 0;
    } else if (axis->speed == 0U) {
        resume(axis, speed);
    } else {
        pos_drive_change(&axis->drive, speed);
        axis->speed = speed;
        tell_speed(axis);
    }
}

bool pos_axis_follow(struct pos_axis *axis)
{
    if (axis->state == (uint8_t)POS_MOVING) {
        follow(axis);
    }
    return pos_drive_is_stirred(&axis->drive) || (axis->waits && !pos_axis_is_busy(axis));
}

bool pos_axis_wants_start(const struct pos_axis *axis)
{
    bool aimed = ((unsigned)axis->own.control2 & (unsigned)POS_CNT_CONT) != 0U;
    return aimed && !pos_axis_is_busy(axis) && is_wanted(axis);
}

static void watch_limit(struct pos_axis *axis, int8_t input)
{
    hal_step_hold();
    axis->watch.limit = input;
    hal_step_release();
}

void pos_axis_start(struct pos_axis *axis, uint64_t start_tick, uint8_t inputs)
{
    if (axis->phase != (uint8_t)POS_PHASE_NONE) {
        pos_home_start(axis, inputs);
    }
    int8_t input = limit_input(axis);
    if (pos_watch_is_active(input, inputs)) {
        pos_axis_fault(axis, POS_ERROR_LIMIT);
    }
    if (axis->state == (uint8_t)POS_FAULT) {
        return;
    }
    if (axis->state != (uint8_t)POS_MOVING) {
        axis->start_tick = start_tick;
    }
    axis->state = (uint8_t)POS_MOVING;
    axis->negative = axis->drive.measure.backward;
    axis->speed = wanted_speed(axis);
    watch_limit(axis, input);
    tell_begin(axis, start_tick);
    pos_drive_start(&axis->drive, axis->speed, start_tick);
    stop_at_switch(axis);
}
