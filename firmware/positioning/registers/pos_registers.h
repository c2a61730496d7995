/*
 * The values of all registers, as plain numbers; reading them by the numbers of the line.
 *
 * The owner puts in what is to be read and takes out what is set. A value has 32 bits; those of I16 and I32 are in
 * two's complement over all of them. A register that two images show is one value. Main only; 650 bytes.
 */
#ifndef POS_REGISTERS_H
#define POS_REGISTERS_H

#include <stdbool.h>
#include <stdint.h>

#include "pos_table.h"

struct pos_registers {
    uint32_t unit[POS_UNIT_REGISTERS];           /* by enum pos_unit_register */
    uint32_t axes[POS_AXES][POS_AXIS_REGISTERS]; /* by enum pos_axis_register; axis 1 first */
};

/* What is there at the start, with the settings as delivered. */
void pos_registers_init(struct pos_registers *registers);

/* All settings as delivered; all else stays. */
void pos_registers_deliver(struct pos_registers *registers);

/* The value of a place, both words of it. */
uint32_t *pos_registers_at(struct pos_registers *registers, const struct pos_place *place);

/* Whether all registers of a range are there, whole; `only_read`: and none can be written. The upper word of FEED may
 * stand alone. */
bool pos_registers_may_read(uint32_t first, uint32_t count, bool only_read);

/* Whether all registers of a range are there, whole, and can be written. */
bool pos_registers_may_write(uint32_t first, uint32_t count);

/* The registers of a range that may be read. */
void pos_registers_read(const struct pos_registers *registers, uint32_t first, uint32_t count, uint16_t *values);

#endif
