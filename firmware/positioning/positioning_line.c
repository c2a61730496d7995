/* Requests: what is written and read is checked, executed and answered as a whole. */
#include "positioning_private.h"

#include <stddef.h>

#include "base_tick.h"
#include "hal_board.h"
#include "hal_line.h"
#include "hal_time.h"

enum {
    WORD_BITS = 16,
    BYTE_BITS = 8,
    CODE_MASK = 0xFF,
    HEARD_MAX = 64, /* bytes in one pass */
    RATE_BD = 100,  /* in which RATE counts */
    STORE_SETTINGS = 1,
    STORE_DELIVERED = 2,
};

#define STORE_PATIENCE_TICKS ((uint64_t)2000 * TICKS_PER_MS)

enum condition {
    CONDITION_NO_CRYSTAL = 1,
    CONDITION_DAMAGED = 2,
    CONDITION_OTHER = 4,
};

/* The codes of INSTRUCTION. */
enum code {
    CODE_NONE,
    CODE_INIT,
    CODE_MODE,
    CODE_RESET,
    CODE_MODE_ABS,
    CODE_HOME,
    CODE_CAPTURE,
};

void positioning_init_line(struct pos_unit *unit)
{
    uint32_t rate_bd = unit->registers.unit[POS_UNIT_RATE] * (uint32_t)RATE_BD;
    enum hal_line_format format = (enum hal_line_format)unit->registers.unit[POS_UNIT_FORMAT];
    hal_line_set(rate_bd, format);
    const struct modbus_setup setup = {
        .start_tick = unit->start_tick,
        .rate_bd = rate_bd,
        .character_bits = format == HAL_LINE_8N1 ? 10U : 11U,
        .identity = {.objects = {"open firmware", "POS4", "01.00"}},
        .node = hal_line_node(),
    };
    modbus_init(&unit->server, &setup);
}

/* ---- values ---------------------------------------------------------------------------------------------------- */

static void show_axis(struct pos_unit *unit, unsigned axis)
{
    struct pos_values values;
    uint32_t *registers = unit->registers.axes[axis - 1U];
    const struct pos_axis *own = &unit->axes[axis - 1U];
    pos_read(unit, axis, &values);
    registers[POS_AXIS_CONTROL] = own->control->control2;
    registers[POS_AXIS_FEED] = own->feed;
    registers[POS_AXIS_STATUS] = ((uint32_t)values.status.status1 << (unsigned)BYTE_BITS) | values.status.status2;
    registers[POS_AXIS_ERROR] = values.error;
    registers[POS_AXIS_FLAGS] = values.flags;
    registers[POS_AXIS_CAPTURES] = values.captures;
    registers[POS_AXIS_POSITION] = (uint32_t)values.position_um;
    registers[POS_AXIS_WAY_LEFT] = (uint32_t)values.way_left_um;
    registers[POS_AXIS_SPEED] = values.speed;
    registers[POS_AXIS_POSITION_STEPS] = (uint32_t)values.position_steps;
    registers[POS_AXIS_CAPTURED] = (uint32_t)values.captured_um;
    registers[POS_AXIS_CAPTURED_STEPS] = (uint32_t)values.captured_steps;
}

static void show_unit(struct pos_unit *unit)
{
    uint32_t *registers = unit->registers.unit;
    unsigned condition = hal_board_may_move() ? 0U : CONDITION_NO_CRYSTAL;
    condition |= unit->settings.damaged ? CONDITION_DAMAGED : 0U;
    condition |= unit->settings.other ? CONDITION_OTHER : 0U;
    registers[POS_UNIT_START_CAUSE] = (uint32_t)hal_board_start_cause();
    registers[POS_UNIT_CONDITION] = condition;
    registers[POS_UNIT_INPUTS] = io_inputs(&unit->io);
    registers[POS_UNIT_LATE_STEPS] = hal_board_late_steps();
    registers[POS_UNIT_UPTIME] = (uint32_t)((hal_time_now() - unit->start_tick) / TICKS_PER_MS);
    registers[POS_UNIT_FRAMES] = unit->server.counts[MODBUS_COUNT_FRAMES];
    registers[POS_UNIT_FOREIGN] = unit->server.counts[MODBUS_COUNT_FOREIGN];
    registers[POS_UNIT_BROKEN] = unit->server.counts[MODBUS_COUNT_BROKEN];
    registers[POS_UNIT_CRC] = unit->server.counts[MODBUS_COUNT_CRC];
    registers[POS_UNIT_LENGTH] = unit->server.counts[MODBUS_COUNT_LENGTH];
    registers[POS_UNIT_PAUSES] = unit->server.counts[MODBUS_COUNT_PAUSES];
    registers[POS_UNIT_EXCEPTIONS] = unit->server.counts[MODBUS_COUNT_EXCEPTIONS];
    registers[POS_UNIT_UNSENT] = unit->server.counts[MODBUS_COUNT_UNSENT];
    registers[POS_UNIT_SILENCES] = unit->silences;
}

static void answer(struct pos_unit *unit, const struct modbus_request *request)
{
    uint16_t values[MODBUS_READ_MAX];
    if (request->read_count == 0U) {
        modbus_answer(&unit->server, NULL);
        return;
    }
    show_unit(unit);
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        show_axis(unit, axis);
    }
    pos_registers_read(&unit->registers, request->read_first, request->read_count, values);
    modbus_answer(&unit->server, values);
}

void positioning_answer(struct pos_unit *unit)
{
    const struct modbus_request *asked = unit->asked;
    unit->asked = NULL;
    if (asked == NULL) {
        return;
    }
    if (unit->exception == MODBUS_EXCEPTION_NONE) {
        answer(unit, asked);
    } else {
        modbus_refuse(&unit->server, unit->exception);
    }
}

/* ---- writes ---------------------------------------------------------------------------------------------------- */

static enum pos_error execute(struct pos_unit *unit, unsigned axis, unsigned code)
{
    const uint32_t *registers = unit->registers.axes[axis - 1U];
    int32_t len_um = wide_to_signed_32(registers[POS_AXIS_LEN]);
    uint16_t accel_mm_s2 = (uint16_t)registers[POS_AXIS_ACCEL];
    unsigned space = (unsigned)registers[POS_AXIS_SPACE];
    enum pos_error error = POS_OK;
    switch ((enum code)code) {
    case CODE_NONE:
        break;
    case CODE_INIT:
        error = pos_init(unit, axis, space);
        break;
    case CODE_MODE:
        error = pos_mode(unit, NULL, len_um, accel_mm_s2, axis);
        break;
    case CODE_RESET:
        error = pos_reset(unit, axis);
        break;
    case CODE_MODE_ABS:
        error = pos_mode_abs(unit, NULL, len_um, accel_mm_s2, axis);
        break;
    case CODE_HOME:
        error = pos_home(unit, NULL, space, len_um, accel_mm_s2, axis);
        break;
    case CODE_CAPTURE:
        error = pos_capture(unit, axis);
        break;
    }
    return error;
}

/* An instruction word that differs from the last one. */
static void instruct(struct pos_unit *unit, const struct pos_written *written)
{
    uint32_t *registers = unit->registers.axes[written->place.axis - 1U];
    if (written->value != registers[POS_AXIS_DONE]) {
        unsigned code = (unsigned)written->value & (unsigned)CODE_MASK;
        registers[POS_AXIS_RESULT] = (uint32_t)execute(unit, written->place.axis, code);
        registers[POS_AXIS_DONE] = written->value;
    }
}

/* CONTROL and FEED of an axis are one POS_CONTROL; one with what there is, where neither is written. */
static void control(struct pos_unit *unit)
{
    struct {
        uint32_t feed;
        int mp;
    } wanted[POS_AXES];
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        wanted[axis].feed = unit->axes[axis].feed;
        wanted[axis].mp = POS_MP_NIL;
    }
    uint32_t next = 0;
    const struct pos_written *written = pos_write_next(&unit->write, POS_USE_MOTION, &next);
    for (; written != NULL; written = pos_write_next(&unit->write, POS_USE_MOTION, &next)) {
        unsigned axis = written->place.axis - 1U;
        if (written->place.index == (uint8_t)POS_AXIS_FEED) {
            wanted[axis].feed = written->value;
        } else {
            wanted[axis].mp = (int)(written->value & (uint32_t)POS_CNT_MP);
        }
    }
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        (void)pos_control(unit, NULL, wanted[axis].feed, wanted[axis].mp, axis + 1U);
    }
}

static void take_settings(struct pos_unit *unit)
{
    uint32_t axes = pos_write_axes(&unit->write);
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        if ((axes >> axis & 1U) != 0U) {
            pos_axis_take_settings(&unit->axes[axis], io_inputs(&unit->io));
        }
    }
    if (axes != 0U) {
        pos_settings_compare(&unit->settings, &unit->registers);
    }
}

/* STORE stands alone in a request that writes it, as no register is beside it. False: it has failed. */
static bool store(struct pos_unit *unit, uint32_t value)
{
    modbus_allow(&unit->server, STORE_PATIENCE_TICKS);
    if (value == (uint32_t)STORE_SETTINGS) {
        return pos_settings_store(&unit->settings, &unit->registers);
    }
    pos_registers_deliver(&unit->registers);
    return true;
}

/* All that the request writes. */
static bool write(struct pos_unit *unit)
{
    uint32_t next = 0;
    const struct pos_written *written = pos_write_next(&unit->write, POS_USE_STORE, &next);
    if (written != NULL && !store(unit, written->value)) {
        return false;
    }
    pos_write_apply(&unit->write, &unit->registers);
    take_settings(unit);
    next = 0;
    written = pos_write_next(&unit->write, POS_USE_INSTRUCTION, &next);
    for (; written != NULL; written = pos_write_next(&unit->write, POS_USE_INSTRUCTION, &next)) {
        instruct(unit, written);
    }
    control(unit);
    return true;
}

/* Whether an axis that settings concern is taken, or moves. */
static bool is_busy(const struct pos_unit *unit, uint32_t axes)
{
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        const struct pos_axis *own = &unit->axes[axis];
        bool free = own->state == (uint8_t)POS_FREE && !pos_axis_is_busy(own);
        if ((axes >> axis & 1U) != 0U && !free) {
            return true;
        }
    }
    return false;
}

enum modbus_exception positioning_write(struct pos_unit *unit, uint32_t first, uint32_t count, const uint16_t *values)
{
    if (!pos_registers_may_write(first, count)) {
        return MODBUS_EXCEPTION_ADDRESS;
    }
    if (!pos_write_init(&unit->write, &unit->registers, first, count, values)) {
        return MODBUS_EXCEPTION_VALUE;
    }
    if (is_busy(unit, pos_write_axes(&unit->write))) {
        return MODBUS_EXCEPTION_BUSY;
    }
    return write(unit) ? MODBUS_EXCEPTION_NONE : MODBUS_EXCEPTION_FAILURE;
}

/* Without an exception all has been done. */
static enum modbus_exception take(struct pos_unit *unit, const struct modbus_request *request)
{
    bool only_read = request->function == (uint8_t)MODBUS_READ_INPUTS;
    if (request->read_count != 0U && !pos_registers_may_read(request->read_first, request->read_count, only_read)) {
        return MODBUS_EXCEPTION_ADDRESS;
    }
    if (request->write_count == 0U) {
        return MODBUS_EXCEPTION_NONE;
    }
    return positioning_write(unit, request->write_first, request->write_count, request->values);
}

/* True: a request has been executed. */
static bool serve(struct pos_unit *unit)
{
    unit->asked = modbus_next(&unit->server);
    if (unit->asked != NULL) {
        unit->exception = take(unit, unit->asked);
    }
    return unit->asked != NULL;
}

/* ---- bytes ----------------------------------------------------------------------------------------------------- */

static void send(struct pos_unit *unit)
{
    while (modbus_is_sending(&unit->server) && hal_line_write(modbus_byte(&unit->server))) {
        modbus_advance(&unit->server);
    }
}

/* One request at most: what it asks for begins before the next one is looked at. True: there may be more. */
static bool hear(struct pos_unit *unit)
{
    struct hal_line_byte byte;
    for (unsigned count = 0; count < (unsigned)HEARD_MAX; count++) {
        if (!hal_line_read(&byte)) {
            return false;
        }
        modbus_take(&unit->server, &byte);
        if (serve(unit)) {
            return true;
        }
    }
    return true;
}

uint64_t positioning_serve(struct pos_unit *unit)
{
    send(unit);
    if (modbus_is_sending(&unit->server) || !hal_line_is_idle()) {
        return TICK_NEVER;
    }
    if (hear(unit)) {
        return hal_time_now();
    }
    uint64_t now = hal_time_now(); /* before the look at the line, as that is to hold for it */
    uint64_t wake = modbus_poll(&unit->server, now, hal_line_is_quiet());
    bool served = serve(unit);
    send(unit);
    return served ? hal_time_now() : wake;
}
