/*
 * The positioning unit: a PLC moves axes by four instructions, over Modbus RTU, or by a program that is linked in.
 *
 * The functions pos_... are the instructions in C; the server of the line calls these and nothing else. Nothing here
 * waits. What they mean is in unit.md.
 */
#ifndef POSITIONING_H
#define POSITIONING_H

#include <stdbool.h>
#include <stdint.h>

#include "../io/io.h"
#include "axis/pos_axis.h"
#include "hal_run.h"
#include "modbus/modbus.h"
#include "registers/pos_registers.h"
#include "registers/pos_write.h"
#include "settings/pos_settings.h"

struct pos_unit {
    struct io io;
    struct hal_client client;
    uint64_t start_tick;
    uint64_t leds_tick; /* when the LEDs are to be looked at */
    uint32_t silences;
    const struct modbus_request *asked; /* it is to be answered yet; NULL: none is */
    enum modbus_exception exception;    /* what came of it */
    struct pos_settings settings;
    struct modbus server;
    struct pos_registers registers;
    struct pos_write write; /* of the request in hand */
    struct pos_axis axes[POS_AXES];
};

/* Start values; takes the stored settings, by which the line is set. Nothing moves. */
void positioning_init(struct pos_unit *unit);

/* Starts the interrupts and the line. */
void positioning_start(struct pos_unit *unit);

/* One pass of main; returns the tick at which to call again at the latest. */
uint64_t positioning_poll(struct pos_unit *unit);

/* Whether nothing moves and nothing waits to be executed or sent. */
bool positioning_is_idle(const struct pos_unit *unit);

/*
 * The instructions: axis 1 to POS_AXES. Each returns POS_OK or why it was refused. Main only, from plc_pass.
 *
 * `control` is in use until POS_RESET or the next one given: the unit writes its bits, and takes MP from it. NULL: a
 * record of the unit's own.
 */
enum pos_error pos_init(struct pos_unit *unit, unsigned axis, unsigned space);
enum pos_error pos_mode(struct pos_unit *unit, struct pos_control_record *control, int32_t len_um, uint16_t accel_mm_s2,
                        unsigned axis);
enum pos_error pos_control(struct pos_unit *unit, struct pos_status_record *status, uint32_t feed, int mp,
                           unsigned axis);
enum pos_error pos_reset(struct pos_unit *unit, unsigned axis);
enum pos_error pos_mode_abs(struct pos_unit *unit, struct pos_control_record *control, int32_t position_um,
                            uint16_t accel_mm_s2, unsigned axis);
enum pos_error pos_home(struct pos_unit *unit, struct pos_control_record *control, unsigned method, int32_t position_um,
                        uint16_t accel_mm_s2, unsigned axis);
enum pos_error pos_capture(struct pos_unit *unit, unsigned axis);

/* What an axis shows now; nothing for an axis that is not there. */
void pos_read(struct pos_unit *unit, unsigned axis, struct pos_values *values);

/* Writes registers, as one request of the line does; what it refuses, it refuses here. */
enum modbus_exception positioning_write(struct pos_unit *unit, uint32_t first, uint32_t count, const uint16_t *values);

/* The PLC program that is linked in: called once in each pass, after the line; to be back within 100 us. The one that
 * is delivered (plc_pass.c) does nothing. */
void plc_pass(struct pos_unit *unit);

#endif
