/*
 * The table of the registers, registers.def, as data; and where a number of the line leads. Pure; may be called from
 * anywhere.
 */
#ifndef POS_TABLE_H
#define POS_TABLE_H

#include <stdbool.h>
#include <stdint.h>

enum {
    POS_AXES = 4,
};

enum pos_unit_register {
#define U(name, number, type, use, form, min, max, start, unit, text) POS_UNIT_##name,
#include "registers.def"
#undef U
    POS_UNIT_REGISTERS
};

enum pos_axis_register {
#define A(name, number, type, use, form, min, max, start, unit, text) POS_AXIS_##name,
#include "registers.def"
#undef A
    POS_AXIS_REGISTERS
};

enum pos_type {
    POS_TYPE_U16,
    POS_TYPE_I16,
    POS_TYPE_U32, /* and above: two registers, the high word first */
    POS_TYPE_I32,
};

/* What becomes of a value that is written, in the order in which a request is executed. */
enum pos_use {
    POS_USE_SETTING,
    POS_USE_PARAMETER,
    POS_USE_INSTRUCTION,
    POS_USE_MOTION,
    POS_USE_STORE,
    POS_USE_READ, /* it cannot be written */
};

/* Which values are taken; registers.def says what each is. */
enum pos_form {
    POS_FORM_ANY,
    POS_FORM_RANGE,
    POS_FORM_ZERO_OR,
    POS_FORM_FACTOR,
    POS_FORM_RATE,
    POS_FORM_CODE,
    POS_FORM_RECORD,
};

struct pos_row {
    int32_t min;
    uint32_t max;
    uint32_t start;  /* a value as in pos_registers.h */
    uint16_t number; /* of an axis register: added to 100 times the axis */
    uint8_t type;    /* enum pos_type */
    uint8_t use;     /* enum pos_use */
    uint8_t form;    /* enum pos_form */
};

/* Where a register of the line is. */
struct pos_place {
    uint8_t axis;  /* 1 to POS_AXES; 0: of the unit */
    uint8_t index; /* enum pos_unit_register or enum pos_axis_register */
    bool low;      /* the lower word of two */
};

extern const struct pos_row pos_unit_rows[POS_UNIT_REGISTERS];
extern const struct pos_row pos_axis_rows[POS_AXIS_REGISTERS];

/* The row of a place. */
static inline const struct pos_row *pos_row(const struct pos_place *place)
{
    return place->axis == 0U ? &pos_unit_rows[place->index] : &pos_axis_rows[place->index];
}

/* Whether it has two registers. */
static inline bool pos_row_is_wide(const struct pos_row *row)
{
    return row->type >= (uint8_t)POS_TYPE_U32;
}

/* Finds a register by its number, images included. False: there is none. */
bool pos_find(uint32_t number, struct pos_place *place);

#endif
