/*
 * The records and numbers that a PLC program sees, as the manual of the unit and its documents name them.
 */
#ifndef POS_RECORDS_H
#define POS_RECORDS_H

#include <stdint.h>

/* POS_CONTROL, byte 2; byte 1 is 0. */
enum {
    POS_CNT_MP = 1,    /* motion permitted */
    POS_CNT_RESET = 2, /* reset of the unit */
    POS_CNT_INIC = 4,  /* start of the initiator */
    POS_CNT_CONT = 8,  /* start of the continuator */
};

/* POS_STATUS, bytes 1 and 2. */
enum {
    POS_STV_JEDE = 1, /* the axis moves */
    POS_STV_SMER = 2, /* direction, 1: negative; kept at rest */
    POS_STV_POL = 8,  /* the wanted position is reached */
};

enum {
    POS_STV_DISP = 1, /* the unit is at the PLC's disposal */
    POS_STV_PROG = 2, /* the unit is programmed */
    POS_STV_ERR = 4,  /* error of the unit */
};

struct pos_control_record {
    uint8_t control1;
    uint8_t control2;
};

struct pos_status_record {
    uint8_t status1;
    uint8_t status2;
};

/* The parameter mp that is left out. */
enum {
    POS_MP_NIL = -1
};

/* Why an instruction was refused, or what a fault was. Faults brake and end the measure: LIMIT, SILENT, SOFT, HOME. */
enum pos_error {
    POS_OK = 0,
    POS_ERROR_AXIS = 1,       /* the axis is not 1 to 4 */
    POS_ERROR_SPACE = 2,      /* the space is not 0 to 6 */
    POS_ERROR_NOT_TAKEN = 3,  /* a measure without POS_INIT before */
    POS_ERROR_MOVES = 4,      /* a measure while another one is being made */
    POS_ERROR_WAY = 5,        /* it is too long */
    POS_ERROR_ACCEL = 6,      /* the acceleration is 0 */
    POS_ERROR_LIMIT = 7,      /* limit input */
    POS_ERROR_SILENT = 8,     /* the bus is silent */
    POS_ERROR_NO_CRYSTAL = 9, /* a measure without the crystal */
    POS_ERROR_SOFT = 10,      /* software limit */
    POS_ERROR_HOME = 11,      /* the switch was not found */
    POS_ERROR_NO_INPUT = 12,  /* the input that is needed has not been set */
    POS_ERROR_METHOD = 13,    /* of POS_HOME: not 19, 21, 37 */
    POS_ERROR_SETTINGS = 14,  /* a measure while the stored settings are damaged */
    POS_ERROR_FAULT = 15,     /* a measure while a fault stands */
};

/* What an axis shows: registers +10 to +27 but DONE and RESULT. */
struct pos_values {
    struct pos_status_record status;
    uint16_t error;      /* enum pos_error */
    uint16_t flags;      /* POS_FLAG_... */
    uint16_t captures;   /* modulo 2^16 */
    int32_t position_um; /* modulo 2^32, as the next four */
    int32_t way_left_um; /* 0 without a target */
    int32_t position_steps;
    int32_t captured_um;
    int32_t captured_steps;
    uint32_t speed; /* 1/65 536 mm/min, at the last pulse; 0 at rest */
};

enum {
    POS_FLAG_REFERENCED = 1,
    POS_FLAG_LIMIT_MINUS = 2, /* this and the next three: the input is active */
    POS_FLAG_LIMIT_PLUS = 4,
    POS_FLAG_REFERENCE = 8,
    POS_FLAG_CAPTURE = 16,
    POS_FLAG_ARMED = 32,
    POS_FLAG_HOMING = 64,
};

#endif
