#include "pos_axis_private.h"

#include <stddef.h>

#include "hal_step.h"
#include "hal_time.h"
#include "hal_trace.h"

enum {
    SPACE_MAX = 6,
};

void pos_axis_mark(struct pos_axis *axis, unsigned set, unsigned cleared)
{
    unsigned permit = (unsigned)axis->control->control2 & (unsigned)POS_CNT_MP;
    unsigned bits = ((unsigned)axis->own.control2 & ~(unsigned)POS_CNT_MP) | permit;
    axis->own.control2 = (uint8_t)((bits & ~cleared) | set);
    *axis->control = axis->own;
}

static struct pos_scale scale_of(const struct pos_axis *axis)
{
    return (struct pos_scale){.steps = pos_axis_setting(axis, POS_AXIS_STEPS),
                              .micrometres = pos_axis_setting(axis, POS_AXIS_MICROMETRES)};
}

/* ---- settings -------------------------------------------------------------------------------------------------- */

static void set_watch(struct pos_axis *axis, uint8_t inputs)
{
    bool active = pos_axis_is_active(axis, POS_AXIS_CAPTURE, inputs);
    hal_step_hold();
    axis->watch.capture_was_active = active;
    axis->watch.reference = (int8_t)pos_axis_signed_setting(axis, POS_AXIS_REFERENCE);
    axis->watch.capture = (int8_t)pos_axis_signed_setting(axis, POS_AXIS_CAPTURE);
    hal_step_release();
}

static void set_polarity(struct pos_axis *axis)
{
    axis->turned = pos_axis_setting(axis, POS_AXIS_INVERT) != 0U;
    hal_step_set_polarity(axis->drive.motor, false, axis->turned);
}

void pos_axis_init(struct pos_axis *axis, unsigned motor, const uint32_t *settings)
{
    *axis = (struct pos_axis){.settings = settings};
    axis->control = &axis->own;
    pos_drive_init(&axis->drive, motor);
    struct pos_scale scale = scale_of(axis);
    axis->backlash_um = (uint16_t)pos_axis_setting(axis, POS_AXIS_BACKLASH);
    pos_frame_init(&axis->frame, &scale, axis->backlash_um);
    set_polarity(axis);
    set_watch(axis, 0);
}

void pos_axis_take_settings(struct pos_axis *axis, uint8_t inputs)
{
    const struct pos_scale scale = scale_of(axis);
    const struct pos_scale *before = &axis->frame.scale;
    bool turned = pos_axis_setting(axis, POS_AXIS_INVERT) != 0U;
    uint32_t backlash_um = pos_axis_setting(axis, POS_AXIS_BACKLASH);
    if (scale.steps != before->steps || scale.micrometres != before->micrometres || turned != axis->turned ||
        backlash_um != axis->backlash_um) {
        axis->backlash_um = (uint16_t)backlash_um;
        pos_frame_reset(&axis->frame, &scale, backlash_um, pos_drive_steps(&axis->drive));
        set_polarity(axis);
    }
    axis->feed_of_speed = 0;
    set_watch(axis, inputs);
}

/* ---- instructions ---------------------------------------------------------------------------------------------- */

static enum pos_error refuse(struct pos_axis *axis, enum pos_error error)
{
    if (axis->error == (uint16_t)POS_OK) {
        axis->error = (uint16_t)error;
    }
    return error;
}

enum pos_error pos_axis_take(struct pos_axis *axis, unsigned space)
{
    if (space > (unsigned)SPACE_MAX) {
        return refuse(axis, POS_ERROR_SPACE);
    }
    axis->state = (uint8_t)POS_TAKEN;
    axis->error = (uint16_t)POS_OK;
    pos_axis_mark(axis, (unsigned)POS_CNT_MP | (unsigned)POS_CNT_RESET, 0);
    pos_axis_give_up(axis, false);
    return POS_OK;
}

void pos_axis_release(struct pos_axis *axis)
{
    axis->state = (uint8_t)POS_FREE;
    axis->error = (uint16_t)POS_OK;
    pos_axis_mark(axis, 0, (unsigned)POS_CNT_MP | (unsigned)POS_CNT_RESET);
    pos_axis_give_up(axis, false);
    axis->control = &axis->own;
    pos_axis_mark(axis, POS_CNT_RESET, 0);
}

/* Whether the order is a measure that needs no motion. */
static bool is_here(const struct pos_order *order)
{
    return order->kind == (uint8_t)POS_KIND_HOME && order->method == (uint32_t)POS_METHOD_HERE;
}

static bool is_method(uint32_t method)
{
    return method == (uint32_t)POS_METHOD_POSITIVE || method == (uint32_t)POS_METHOD_NEGATIVE ||
           method == (uint32_t)POS_METHOD_HERE;
}

static bool is_too_long(const struct pos_axis *axis, const struct pos_order *order)
{
    bool is_far = order->len_um == INT32_MIN;
    if (order->kind == (uint8_t)POS_KIND_WAY) {
        is_far = is_far || !pos_frame_may_aim(&axis->frame, order->len_um);
    } else if (order->kind == (uint8_t)POS_KIND_POSITION) {
        int64_t way_um = order->len_um - pos_frame_position_um(&axis->frame, axis->frame.step);
        is_far = is_far || way_um > INT32_MAX || way_um < -INT32_MAX;
    } else {
        /* homing goes as far as HOME_WAY */
    }
    return is_far;
}

/* Why the state of the axis forbids a measure. */
static enum pos_error check_state(const struct pos_axis *axis)
{
    static const uint8_t errors[POS_FAULT + 1] = {
        [POS_FREE] = POS_ERROR_NOT_TAKEN, [POS_TAKEN] = POS_OK,   [POS_WAITING] = POS_ERROR_MOVES, [POS_READY] = POS_OK,
        [POS_MOVING] = POS_ERROR_MOVES,   [POS_REACHED] = POS_OK, [POS_FAULT] = POS_ERROR_FAULT,
    };
    return (enum pos_error)errors[axis->state];
}

/* Why a measure that needs motion cannot be made. */
static enum pos_error check_motion(const struct pos_axis *axis, const struct pos_order *order,
                                   const struct pos_allowed *allowed)
{
    if (!allowed->settings) {
        return POS_ERROR_SETTINGS;
    }
    if (!allowed->crystal) {
        return POS_ERROR_NO_CRYSTAL;
    }
    if (order->kind == (uint8_t)POS_KIND_HOME && pos_axis_setting(axis, POS_AXIS_REFERENCE) == 0U) {
        return POS_ERROR_NO_INPUT;
    }
    return order->accel_mm_s2 == 0U ? POS_ERROR_ACCEL : POS_OK;
}

/* In the order in which the causes count. */
static enum pos_error check(const struct pos_axis *axis, const struct pos_order *order,
                            const struct pos_allowed *allowed)
{
    enum pos_error error = check_state(axis);
    if (error == POS_OK && order->kind == (uint8_t)POS_KIND_HOME && !is_method(order->method)) {
        error = POS_ERROR_METHOD;
    }
    if (error == POS_OK && !is_here(order)) {
        error = check_motion(axis, order, allowed);
    }
    return error == POS_OK && is_too_long(axis, order) ? POS_ERROR_WAY : error;
}

enum pos_error pos_axis_order(struct pos_axis *axis, struct pos_control_record *control, const struct pos_order *order,
                              const struct pos_allowed *allowed)
{
    pos_axis_look(axis); /* a way counts from where the axis is, braking too */
    enum pos_error error = check(axis, order, allowed);
    if (error != POS_OK) {
        return refuse(axis, error);
    }
    axis->control = control != NULL ? control : &axis->own;
    axis->state = (uint8_t)(pos_axis_is_busy(axis) ? POS_WAITING : POS_READY);
    pos_axis_drop(axis);
    axis->order = *order;
    axis->waits = true;
    pos_axis_mark(axis, POS_CNT_INIC, POS_CNT_RESET);
    return POS_OK;
}

enum pos_error pos_axis_capture(struct pos_axis *axis)
{
    if (pos_axis_setting(axis, POS_AXIS_CAPTURE) == 0U) {
        return refuse(axis, POS_ERROR_NO_INPUT);
    }
    hal_step_hold();
    axis->watch.armed = true;
    hal_step_release();
    return POS_OK;
}

void pos_axis_control(struct pos_axis *axis, uint32_t feed, int mp)
{
    if (axis->state == (uint8_t)POS_FREE) {
        return;
    }
    if (mp != POS_MP_NIL) {
        pos_axis_mark(axis, mp != 0 ? POS_CNT_MP : 0U, mp != 0 ? 0U : POS_CNT_MP);
    }
    if (axis->state != (uint8_t)POS_TAKEN && axis->state != (uint8_t)POS_FAULT) {
        axis->feed = feed;
    }
}

void pos_axis_fault(struct pos_axis *axis, enum pos_error error)
{
    if (axis->state != (uint8_t)POS_FREE && axis->state != (uint8_t)POS_FAULT) {
        axis->state = (uint8_t)POS_FAULT;
        axis->error = (uint16_t)error;
        hal_trace(hal_time_now(), axis->drive.motor + 1U, HAL_TRACE_ERROR, (int64_t)error);
        pos_axis_give_up(axis, true);
    }
}

/* ---- what it shows --------------------------------------------------------------------------------------------- */

bool pos_axis_is_busy(const struct pos_axis *axis)
{
    return pos_drive_is_busy(&axis->drive);
}

bool pos_axis_moves(const struct pos_axis *axis)
{
    bool moves = axis->state == (uint8_t)POS_MOVING || pos_axis_is_busy(axis);
    return moves && hal_time_now() >= axis->start_tick;
}

bool pos_axis_is_active(const struct pos_axis *axis, enum pos_axis_register input, uint8_t inputs)
{
    return pos_watch_is_active(pos_axis_signed_setting(axis, input), inputs);
}

struct pos_status_record pos_axis_status(const struct pos_axis *axis)
{
    static const uint8_t bits[] = {
        [POS_FREE] = 0,
        [POS_TAKEN] = POS_STV_DISP,
        [POS_WAITING] = POS_STV_DISP | POS_STV_PROG,
        [POS_READY] = POS_STV_DISP | POS_STV_PROG,
        [POS_MOVING] = POS_STV_DISP | POS_STV_PROG,
        [POS_REACHED] = POS_STV_DISP | POS_STV_PROG,
        [POS_FAULT] = POS_STV_DISP,
    };
    unsigned first = pos_axis_moves(axis) ? POS_STV_JEDE : 0U;
    first |= axis->negative ? POS_STV_SMER : 0U;
    first |= axis->state == (uint8_t)POS_REACHED ? POS_STV_POL : 0U;
    unsigned second = (unsigned)bits[axis->state] | (axis->error != (uint16_t)POS_OK ? POS_STV_ERR : 0U);
    return (struct pos_status_record){.status1 = (uint8_t)first, .status2 = (uint8_t)second};
}

static uint16_t flags_of(const struct pos_axis *axis, uint8_t inputs)
{
    unsigned flags = axis->frame.referenced ? POS_FLAG_REFERENCED : 0U;
    flags |= pos_axis_is_active(axis, POS_AXIS_LIMIT_MINUS, inputs) ? POS_FLAG_LIMIT_MINUS : 0U;
    flags |= pos_axis_is_active(axis, POS_AXIS_LIMIT_PLUS, inputs) ? POS_FLAG_LIMIT_PLUS : 0U;
    flags |= pos_axis_is_active(axis, POS_AXIS_REFERENCE, inputs) ? POS_FLAG_REFERENCE : 0U;
    flags |= pos_axis_is_active(axis, POS_AXIS_CAPTURE, inputs) ? POS_FLAG_CAPTURE : 0U;
    flags |= axis->watch.armed ? POS_FLAG_ARMED : 0U;
    flags |= axis->phase != (uint8_t)POS_PHASE_NONE ? POS_FLAG_HOMING : 0U;
    return (uint16_t)flags;
}

/* The low 32 bits, as a signed number. */
static int32_t low_of(int64_t value)
{
    return wide_to_signed_32((uint32_t)wide_from_signed(value));
}

void pos_axis_read(struct pos_axis *axis, uint8_t inputs, struct pos_values *values)
{
    pos_axis_look(axis);
    bool way = (axis->state == (uint8_t)POS_READY && !axis->waits) || axis->state == (uint8_t)POS_MOVING;
    bool aims = way && axis->phase == (uint8_t)POS_PHASE_NONE;
    *values = (struct pos_values){
        .status = pos_axis_status(axis),
        .error = axis->error,
        .flags = flags_of(axis, inputs),
        .captures = axis->captures,
        .position_um = low_of(pos_frame_position_um(&axis->frame, axis->frame.step)),
        .way_left_um = aims ? low_of(pos_frame_left_um(&axis->frame, &axis->target)) : 0,
        .position_steps = low_of(axis->frame.step),
        .captured_um = low_of(axis->captured_um),
        .captured_steps = low_of(axis->captured_step),
        .speed = pos_measure_feed(&axis->frame.scale, pos_drive_speed(&axis->drive)),
    };
}
