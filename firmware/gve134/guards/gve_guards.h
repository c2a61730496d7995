/*
 * Guards: which inputs interrupt the motion, at which level, and which have.
 *
 * The unit has sixteen interrupts in two ports of eight; inputs are behind six of them: 0 to 3 are the reference
 * switches of X, Y, Z, A, 14 and 15 button and plate of the tool sensor. ST0, ST2, ST4 are of port 1, ST1, ST3, ST5 of
 * port 2. Ports read levels: 0 is an input that is closed to ground, a bit without an input is 1. Main, and the tick
 * interrupt where said.
 */
#ifndef GVE_GUARDS_H
#define GVE_GUARDS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* The bytes that a host reads and writes, by their number as a status. */
enum gve_status {
    GVE_STATUS_ENABLED_1,
    GVE_STATUS_ENABLED_2,
    GVE_STATUS_LEVEL_1,
    GVE_STATUS_LEVEL_2,
    GVE_STATUS_CAUSE_1,
    GVE_STATUS_CAUSE_2,
    GVE_STATUS_GUARDS, /* so many are of the guards */
};

struct gve_guards {
    _Atomic uint8_t status[GVE_STATUS_GUARDS];
};

/* All 0. */
void gve_guards_init(struct gve_guards *guards);

uint8_t gve_guards_read(const struct gve_guards *guards, enum gve_status status);
void gve_guards_write(struct gve_guards *guards, enum gve_status status, uint8_t byte);

/* The causes become 0. */
void gve_guards_clear_causes(struct gve_guards *guards);

/* Port 1 (0) or 2 (1) for levels as io.h has them: there 1 is an input that is closed. */
uint8_t gve_guards_port(uint8_t inputs, unsigned port);

/* The interrupts that are enabled and active, bit 0 is INTR0. Also in the tick interrupt. */
uint16_t gve_guards_active(const struct gve_guards *guards, uint8_t inputs);

/* Whether the reference switch of an axis is active, enabled or not. Also in the tick interrupt. */
bool gve_guards_switch(const struct gve_guards *guards, uint8_t inputs, unsigned axis);

/* Adds interrupts to the causes. Also in the tick interrupt, which may come in between: nothing is lost. */
void gve_guards_add_causes(struct gve_guards *guards, uint16_t active);

#endif
