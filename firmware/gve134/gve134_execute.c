#include "gve134_private.h"

#include "base_tick.h"
#include "base_wide.h"
#include "gve_float.h"
#include "hal_board.h"
#include "hal_time.h"

enum {
    COUPLED_AXIS = 3,
    BYTE_DIGITS = 2,
    WORD_DIGITS = 8,
    PORTS = 2,
    STATUS_FLAGS = 6, /* the number of the status with the bits below */
    LATE_SHOWN_MAX = 0xFF,
};

/* Bits of ST6. */
enum {
    FLAG_STOP = 0x01,
    FLAG_NO_CRYSTAL = 0x04,
    FLAG_FAULTED = 0x08,
    FLAG_INTCOM = 0x10,
    FLAG_FULL = 0x20, /* in F only */
    FLAG_RUN = 0x40,
    FLAG_INTA = 0x80,
};

static uint8_t inputs_of(const struct gve134 *unit)
{
    return io_inputs(&unit->io);
}

/* ---- what is refused ------------------------------------------------------------------------------------------- */

static enum gve_state state_of(const struct gve134 *unit)
{
    if (gve134_is_locked(unit)) {
        return GVE_STATE_LOCKED;
    }
    if (gve_queue_inta(&unit->queue)) {
        return gve_queue_runs(&unit->queue) ? GVE_STATE_WAITING : GVE_STATE_ENDED;
    }
    return gve_queue_runs(&unit->queue) ? GVE_STATE_WORK : GVE_STATE_REST;
}

bool gve134_is_coupled_out(const struct gve134 *unit, const struct gve_command *command)
{
    if (unit->queue.coupling == (uint8_t)COUPLED_AXIS) {
        return false;
    }
    switch (command->opcode) {
    case GVE_LINE:
    case GVE_CONTINUE:
        return command->numbers[COUPLED_AXIS] != 0;
    case GVE_SET_POSITION:
    case GVE_REFERENCE:
        return command->numbers[0] == COUPLED_AXIS;
    default:
        return false;
    }
}

/* ---- vectors and speeds ---------------------------------------------------------------------------------------- */

static enum gve_code enter(struct gve134 *unit, const int32_t numbers[])
{
    const int32_t steps[PATH_AXES] = {numbers[0], numbers[1], numbers[2], numbers[3]};
    if (gve134_has_pulses(steps)) {
        gve_queue_enter(&unit->queue, steps);
        gve_queue_begin(&unit->queue, inputs_of(unit));
    }
    return GVE_DONE;
}

static enum gve_code enter_joining(struct gve134 *unit, const int32_t numbers[])
{
    return gve_queue_room(&unit->queue) == 0 ? GVE_NO_ROOM : enter(unit, numbers);
}

static void set_four(uint32_t values[PATH_AXES], const int32_t numbers[])
{
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        values[axis] = (uint32_t)numbers[axis];
    }
}

void gve134_change(struct gve134 *unit, const struct gve_command *command)
{
    struct gve_queue *queue = &unit->queue;
    if (command->opcode == (uint8_t)GVE_CHANGE_UP) {
        gve_queue_change(queue, gve_factor_up(queue->factor), false);
    } else if (command->opcode == (uint8_t)GVE_CHANGE_DOWN) {
        gve_queue_change(queue, gve_factor_down(queue->factor), false);
    } else if (command->opcode == (uint8_t)GVE_CHANGE_TO) {
        gve_queue_change(queue, (uint32_t)command->numbers[0] * GVE_FACTOR_PER_CENT, true);
    } else {
        gve_queue_change(queue, GVE_FACTOR_ONE, true);
    }
}

/* ---- stops ----------------------------------------------------------------------------------------------------- */

static void halt(struct gve134 *unit, struct gve134_reply *reply)
{
    if (!gve_queue_halt(&unit->queue)) {
        unit->waiting = (uint8_t)GVE134_WAITS_FOR_HALT;
        reply->later = true;
    }
}

/* Where there is nothing to go on with, what stopped it is cleared all the same. */
static enum gve_code go(struct gve134 *unit, enum gve_code refusal)
{
    if (state_of(unit) == GVE_STATE_ENDED || refusal == GVE_DONE) {
        gve_queue_go(&unit->queue, inputs_of(unit));
    }
    return refusal;
}

static void delete_all(struct gve134 *unit)
{
    gve_queue_delete(&unit->queue);
    if (unit->faulted) {
        unit->faulted = false;
        if (!gve134_is_locked(unit)) {
            gve_outputs_unlock(&unit->outputs, hal_time_now());
        }
    }
}

static void home(struct gve134 *unit, const int32_t numbers[], struct gve134_reply *reply)
{
    const struct gve_home_order order = {
        .axis = (unsigned)numbers[0],
        .way = numbers[1],
        .speed = (uint32_t)numbers[2],
        .way_back = numbers[3],
        .speed_back = (uint32_t)numbers[4],
    };
    unit->waiting = (uint8_t)GVE134_WAITS_FOR_HOME;
    reply->later = true;
    gve_queue_home(&unit->queue, &order, inputs_of(unit));
}

/* ---- positions ------------------------------------------------------------------------------------------------- */

static void put_positions(struct text *text, const int64_t steps[UNIT_MOTORS], unsigned axes)
{
    for (unsigned axis = 0; axis < axes; axis++) {
        if (axis != 0) {
            text_put_byte(text, ',');
        }
        text_put_signed(text, wide_to_signed_32((uint32_t)(wide_from_signed(steps[axis]) & UINT32_MAX)), 0);
    }
}

static void tell_positions(const struct gve134 *unit, struct gve134_reply *reply, unsigned axes)
{
    int64_t steps[UNIT_MOTORS];
    gve_queue_positions(&unit->queue, steps);
    put_positions(&reply->values, steps, axes);
}

static void tell_latched(const struct gve134 *unit, struct gve134_reply *reply)
{
    int64_t steps[UNIT_MOTORS];
    gve_queue_latched(&unit->queue, steps);
    put_positions(&reply->values, steps, UNIT_MOTORS);
}

static void zero_positions(struct gve134 *unit)
{
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        gve_queue_set_position(&unit->queue, axis, 0);
    }
}

/* ---- status ---------------------------------------------------------------------------------------------------- */

static unsigned when(bool set, unsigned flag)
{
    return set ? flag : 0U;
}

static uint8_t flags_of(const struct gve134 *unit)
{
    const struct gve_queue *queue = &unit->queue;
    return (uint8_t)(when(gve_queue_is_stopping(queue), FLAG_STOP) | when(!hal_board_may_move(), FLAG_NO_CRYSTAL) |
                     when(unit->faulted, FLAG_FAULTED) | when(queue->intcom, FLAG_INTCOM) |
                     when(gve_queue_runs(queue), FLAG_RUN) | when(gve134_inta(unit), FLAG_INTA));
}

/* Neither L nor C. */
static bool is_full(const struct gve134 *unit)
{
    return gve_queue_runs(&unit->queue) && gve_queue_room(&unit->queue) == 0;
}

static uint8_t late_of(const struct gve134 *unit)
{
    uint32_t late = hal_board_late_steps() - unit->late_before;
    return (uint8_t)(late > (uint32_t)LATE_SHOWN_MAX ? (uint32_t)LATE_SHOWN_MAX : late);
}

static void put_byte(struct gve134_reply *reply, unsigned byte)
{
    text_put_hex(&reply->values, byte, BYTE_DIGITS);
}

static uint8_t status_of(const struct gve134 *unit, unsigned status)
{
    if (status < (unsigned)GVE_STATUS_GUARDS) {
        return gve_guards_read(&unit->queue.guards, (enum gve_status)status);
    }
    return status == (unsigned)STATUS_FLAGS ? flags_of(unit) : late_of(unit);
}

static void write_flags(struct gve134 *unit, unsigned byte)
{
    if (!gve_queue_moves(&unit->queue)) {
        gve_queue_write_flags(&unit->queue, (byte & (unsigned)FLAG_INTA) != 0, (byte & (unsigned)FLAG_INTCOM) != 0,
                              inputs_of(unit));
    } else if ((byte & (unsigned)FLAG_STOP) != 0) {
        gve_queue_stop(&unit->queue);
    } else {
        /* nothing else of it counts while axes move */
    }
}

static void write_status(struct gve134 *unit, unsigned status, unsigned byte)
{
    if (status == (unsigned)STATUS_FLAGS) {
        write_flags(unit, byte);
    } else {
        gve_guards_write(&unit->queue.guards, (enum gve_status)status, (uint8_t)byte);
        gve_queue_sense(&unit->queue, inputs_of(unit));
    }
}

/* ---- memory ---------------------------------------------------------------------------------------------------- */

static void tell_serial(const struct gve134 *unit, struct gve134_reply *reply)
{
    for (unsigned i = 0; i < (unsigned)GVE_MEMORY_WORD_BYTES; i++) {
        put_byte(reply, unit->memory.bytes[(unsigned)GVE_MEMORY_SERIAL + i]);
    }
}

static enum gve_code written(struct gve134 *unit, enum store_error error)
{
    if (error != STORE_OK) {
        return GVE_NOT_NOW;
    }
    gve134_apply_memory(unit);
    return GVE_DONE;
}

static enum gve_code write_byte(struct gve134 *unit, const int32_t numbers[])
{
    return written(unit, gve_memory_write_byte(&unit->memory, (uint32_t)numbers[0], (uint8_t)numbers[1]));
}

static enum gve_code write_word(struct gve134 *unit, const int32_t numbers[])
{
    return written(unit, gve_memory_write_word(&unit->memory, (uint32_t)numbers[0], (uint32_t)numbers[1]));
}

/* ---- all commands ---------------------------------------------------------------------------------------------- */

static void execute_reading(const struct gve134 *unit, const struct gve_command *command, struct gve134_reply *reply)
{
    unsigned place = (unsigned)command->numbers[0];
    switch (command->opcode) {
    case GVE_VERSION:
        text_put_string(&reply->values, GVE134_VERSION);
        break;
    case GVE_SERIAL:
        tell_serial(unit, reply);
        break;
    case GVE_POSITION_2:
        tell_positions(unit, reply, 2);
        break;
    case GVE_POSITION_3:
        tell_positions(unit, reply, 3);
        break;
    case GVE_POSITION_4:
        tell_positions(unit, reply, UNIT_MOTORS);
        break;
    case GVE_POSITION_LATCHED:
        tell_latched(unit, reply);
        break;
    case GVE_READ_STATUS:
        put_byte(reply, status_of(unit, place));
        break;
    case GVE_FLAGS:
        put_byte(reply, flags_of(unit) | when(is_full(unit), FLAG_FULL));
        break;
    case GVE_INPUTS_1:
        put_byte(reply, gve_guards_port(inputs_of(unit), 0));
        break;
    case GVE_INPUTS_2:
        put_byte(reply, gve_guards_port(inputs_of(unit), 1));
        break;
    case GVE_READ_BYTE:
        put_byte(reply, unit->memory.bytes[place]);
        break;
    case GVE_READ_WORD:
        text_put_hex(&reply->values, gve_memory_word(&unit->memory, place), WORD_DIGITS);
        break;
    case GVE_READ_SINGLE:
        gve_float_put(&reply->values, gve_memory_word(&unit->memory, place));
        break;
    default:
        break;
    }
}

static void execute_setting(struct gve134 *unit, const struct gve_command *command)
{
    struct gve_modal *modal = &unit->queue.modal;
    uint32_t number = (uint32_t)command->numbers[0];
    switch (command->opcode) {
    case GVE_PAUSE:
        modal->pause_ms = number;
        break;
    case GVE_SHORT:
        modal->short_pulses = number;
        break;
    case GVE_ACCELERATION:
        modal->accel = number;
        break;
    case GVE_SPEED:
        modal->speed = number;
        break;
    case GVE_BRAKE:
        modal->brake = number;
        break;
    case GVE_CORRECTED:
        modal->corrected = true;
        break;
    case GVE_UNCORRECTED:
        modal->corrected = false;
        break;
    case GVE_LIMITS:
        set_four(modal->limit, command->numbers);
        break;
    case GVE_JUMPS:
        set_four(modal->jump, command->numbers);
        break;
    default:
        break;
    }
}

static enum gve_code execute_stopping(struct gve134 *unit, const struct gve_command *command,
                                      struct gve134_reply *reply)
{
    switch (command->opcode) {
    case GVE_REFERENCE:
        home(unit, command->numbers, reply);
        break;
    case GVE_HALT:
        halt(unit, reply);
        break;
    case GVE_DELETE:
        delete_all(unit);
        break;
    case GVE_KEEP:
        return gve_queue_keep(&unit->queue) ? GVE_DONE : GVE_NO_ROOM;
    case GVE_RESTORE:
        return gve_queue_restore(&unit->queue) ? GVE_DONE : GVE_NOTHING_LEFT;
    default:
        break;
    }
    return GVE_DONE;
}

static enum gve_code execute_acting(struct gve134 *unit, const struct gve_command *command, struct gve134_reply *reply)
{
    const int32_t *numbers = command->numbers;
    switch (command->opcode) {
    case GVE_LINE:
        return enter(unit, numbers);
    case GVE_CONTINUE:
        return enter_joining(unit, numbers);
    case GVE_CHANGE_ALL:
    case GVE_CHANGE_UP:
    case GVE_CHANGE_DOWN:
    case GVE_CHANGE_TO:
        reply->changes = true;
        break;
    case GVE_ZERO:
        zero_positions(unit);
        break;
    case GVE_SET_POSITION:
        gve_queue_set_position(&unit->queue, (unsigned)numbers[0], numbers[1]);
        break;
    case GVE_WRITE_STATUS:
        write_status(unit, (unsigned)numbers[0], (unsigned)numbers[1]);
        break;
    case GVE_OUTPUTS:
        gve_outputs_write(&unit->outputs, (uint8_t)numbers[1]);
        break;
    case GVE_WRITE_BYTE:
        return write_byte(unit, numbers);
    case GVE_WRITE_WORD:
    case GVE_WRITE_SINGLE:
        return write_word(unit, numbers);
    case GVE_RESET:
        gve134_abort(unit);
        break;
    case GVE_SPINDLE:
        gve_outputs_spindle(&unit->outputs, (uint32_t)numbers[0]);
        break;
    case GVE_PACKET_END:
        return GVE_WRONG_SYNTAX; /* nothing has begun one */
    default:
        execute_setting(unit, command);
        execute_reading(unit, command, reply);
        return execute_stopping(unit, command, reply);
    }
    return GVE_DONE;
}

void gve134_execute(struct gve134 *unit, const struct gve_request *request, struct gve134_reply *reply)
{
    const struct gve_command *command = &request->command;
    reply->code = gve_fault_code((enum gve_fault)request->fault);
    if (reply->code != GVE_DONE) {
        return;
    }
    if (gve134_is_coupled_out(unit, command)) {
        reply->code = GVE_OUT_OF_BOUNDS;
        return;
    }
    enum gve_code refusal = gve_refusal(command->opcode, state_of(unit));
    if (command->opcode == (uint8_t)GVE_GO) {
        reply->code = go(unit, refusal);
    } else if (refusal != GVE_DONE) {
        reply->code = refusal;
    } else {
        reply->code = execute_acting(unit, command, reply);
    }
}
