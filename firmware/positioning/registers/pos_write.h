/*
 * A write of one request, before it is executed: values by the numbers of the line in, values of registers out, in the
 * order in which they count. All of them are right, or there is no write.
 *
 * The owner has made sure that the range may be written (pos_registers.h). Main only; 1 kB.
 */
#ifndef POS_WRITE_H
#define POS_WRITE_H

#include <stdbool.h>
#include <stdint.h>

#include "pos_registers.h"

enum {
    POS_WRITE_MAX = 123, /* registers of a request */
};

struct pos_written {
    uint32_t value;
    struct pos_place place; /* never a lower word */
};

struct pos_write {
    uint32_t count; /* of the values */
    struct pos_written written[POS_WRITE_MAX];
};

/* Takes `count` registers, 1 to POS_WRITE_MAX, from `first` on. False: a value is out of its range, or one of STEPS
 * and MICROMETRES does not suit the other one, which is that in `registers` if it is not written. The upper word of
 * FEED alone makes the lower one 0; of CONTROL only MP is kept. */
bool pos_write_init(struct pos_write *write, const struct pos_registers *registers, uint32_t first, uint32_t count,
                    const uint16_t *values);

/* The axes that settings of this write, or STORE, concern: bit 0 is axis 1. */
uint32_t pos_write_axes(const struct pos_write *write);

/* Steps through the values of one use: *next is 0 at the beginning. NULL: there are no more. Of instructions, and so of
 * all, those of axis 1 come first. */
const struct pos_written *pos_write_next(const struct pos_write *write, enum pos_use use, uint32_t *next);

/* Puts all values into `registers`, but STORE, which reads 0. */
void pos_write_apply(const struct pos_write *write, struct pos_registers *registers);

#endif
