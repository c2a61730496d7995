/* The instructions, as a PLC program calls them. */
#include "positioning_private.h"

#include <stddef.h>

#include "hal_board.h"

static struct pos_axis *axis_of(struct pos_unit *unit, unsigned axis)
{
    return axis >= 1U && axis <= (unsigned)POS_AXES ? &unit->axes[axis - 1U] : NULL;
}

static enum pos_error give(struct pos_unit *unit, struct pos_control_record *control, const struct pos_order *order,
                           unsigned axis)
{
    struct pos_axis *own = axis_of(unit, axis);
    if (own == NULL) {
        return POS_ERROR_AXIS;
    }
    const struct pos_allowed allowed = {.crystal = hal_board_may_move(), .settings = !unit->settings.damaged};
    return pos_axis_order(own, control, order, &allowed);
}

enum pos_error pos_init(struct pos_unit *unit, unsigned axis, unsigned space)
{
    struct pos_axis *own = axis_of(unit, axis);
    return own != NULL ? pos_axis_take(own, space) : POS_ERROR_AXIS;
}

enum pos_error pos_mode(struct pos_unit *unit, struct pos_control_record *control, int32_t len_um, uint16_t accel_mm_s2,
                        unsigned axis)
{
    const struct pos_order order = {.kind = POS_KIND_WAY, .len_um = len_um, .accel_mm_s2 = accel_mm_s2};
    return give(unit, control, &order, axis);
}

enum pos_error pos_mode_abs(struct pos_unit *unit, struct pos_control_record *control, int32_t position_um,
                            uint16_t accel_mm_s2, unsigned axis)
{
    const struct pos_order order = {.kind = POS_KIND_POSITION, .len_um = position_um, .accel_mm_s2 = accel_mm_s2};
    return give(unit, control, &order, axis);
}

enum pos_error pos_home(struct pos_unit *unit, struct pos_control_record *control, unsigned method, int32_t position_um,
                        uint16_t accel_mm_s2, unsigned axis)
{
    const struct pos_order order = {
        .kind = POS_KIND_HOME, .method = method, .len_um = position_um, .accel_mm_s2 = accel_mm_s2};
    return give(unit, control, &order, axis);
}

enum pos_error pos_control(struct pos_unit *unit, struct pos_status_record *status, uint32_t feed, int mp,
                           unsigned axis)
{
    struct pos_axis *own = axis_of(unit, axis);
    if (own == NULL) {
        return POS_ERROR_AXIS;
    }
    pos_axis_control(own, feed, mp);
    if (status != NULL) {
        *status = pos_axis_status(own);
    }
    return POS_OK;
}

enum pos_error pos_reset(struct pos_unit *unit, unsigned axis)
{
    struct pos_axis *own = axis_of(unit, axis);
    if (own == NULL) {
        return POS_ERROR_AXIS;
    }
    pos_axis_release(own);
    return POS_OK;
}

enum pos_error pos_capture(struct pos_unit *unit, unsigned axis)
{
    struct pos_axis *own = axis_of(unit, axis);
    return own != NULL ? pos_axis_capture(own) : POS_ERROR_AXIS;
}

void pos_read(struct pos_unit *unit, unsigned axis, struct pos_values *values)
{
    struct pos_axis *own = axis_of(unit, axis);
    if (own != NULL) {
        pos_axis_read(own, io_inputs(&unit->io), values);
    }
}
