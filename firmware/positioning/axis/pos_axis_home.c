/* Homing: to the switch, off it the other way, and to where the switch was left. */
#include "pos_axis_private.h"

#include "hal_step.h"

static bool is_positive(const struct pos_axis *axis)
{
    return axis->order.method == (uint32_t)POS_METHOD_POSITIVE;
}

static void seek(struct pos_axis *axis, enum pos_seek what, uint8_t inputs)
{
    bool active = pos_axis_is_active(axis, POS_AXIS_REFERENCE, inputs);
    hal_step_hold();
    axis->watch.seek = (uint8_t)what;
    axis->watch.reference_hit = false;
    axis->watch.reference_was_active = active;
    hal_step_release();
    axis->found = false;
}

static int64_t way_of(const struct pos_axis *axis, bool positive)
{
    int64_t steps = pos_measure_step(&axis->frame.scale, pos_axis_setting(axis, POS_AXIS_HOME_WAY));
    return positive ? steps : -steps;
}

static void refer(struct pos_axis *axis, int64_t step)
{
    pos_frame_refer(&axis->frame, step, axis->order.len_um);
    pos_axis_reached(axis);
}

/* The part that follows `phase`; it may have nothing to do. */
static void enter(struct pos_axis *axis, enum pos_phase phase, uint8_t inputs)
{
    axis->phase = (uint8_t)phase;
    if (phase == POS_PHASE_RETURN) {
        seek(axis, POS_SEEK_NOTHING, inputs);
        if (!pos_axis_aim(axis, axis->reference_step)) {
            refer(axis, axis->reference_step);
        }
        return;
    }
    bool find = phase == POS_PHASE_FIND;
    seek(axis, find ? POS_SEEK_ACTIVE : POS_SEEK_INACTIVE, inputs);
    if (!pos_axis_aim(axis, axis->frame.step + way_of(axis, is_positive(axis) == find))) {
        pos_axis_fault(axis, POS_ERROR_HOME);
    }
}

void pos_home_prepare(struct pos_axis *axis)
{
    if (axis->order.method == (uint32_t)POS_METHOD_HERE) {
        refer(axis, axis->frame.step);
    } else {
        axis->phase = (uint8_t)POS_PHASE_READY;
        pos_axis_mark(axis, POS_CNT_CONT, 0);
    }
}

void pos_home_start(struct pos_axis *axis, uint8_t inputs)
{
    axis->frame.referenced = false;
    if (axis->phase == (uint8_t)POS_PHASE_READY) {
        bool active = pos_axis_is_active(axis, POS_AXIS_REFERENCE, inputs);
        enter(axis, active ? POS_PHASE_LEAVE : POS_PHASE_FIND, inputs);
    }
}

void pos_home_follow(struct pos_axis *axis, uint8_t inputs)
{
    if (axis->phase == (uint8_t)POS_PHASE_RETURN) {
        refer(axis, axis->reference_step);
    } else if (!axis->found) {
        pos_axis_fault(axis, POS_ERROR_HOME);
    } else {
        enter(axis, axis->phase == (uint8_t)POS_PHASE_FIND ? POS_PHASE_LEAVE : POS_PHASE_RETURN, inputs);
    }
}

uint32_t pos_home_feed(const struct pos_axis *axis)
{
    return pos_axis_setting(axis, axis->phase == (uint8_t)POS_PHASE_FIND ? POS_AXIS_HOME_FEED : POS_AXIS_HOME_SLOW);
}
