/*
 * The frame and its times (line.md, "A frame"). Constants only.
 *
 *     address | function | data | CRC low | CRC high
 */
#ifndef MODBUS_FRAME_H
#define MODBUS_FRAME_H

#include <assert.h>
#include <stdint.h>

#include "base_tick.h"

enum {
    MODBUS_ADDRESS_BROADCAST = 0, /* all units; none answers */
    MODBUS_NODE_MAX = 16,

    MODBUS_ADDRESS_BYTES = 1,
    MODBUS_CRC_BYTES = 2,
    MODBUS_FRAME_BYTES_MIN = 4,
    MODBUS_FRAME_BYTES_MAX = 256,

    MODBUS_READ_MAX = 125,       /* registers */
    MODBUS_WRITE_MAX = 123,      /* in a request that only writes */
    MODBUS_WRITE_READ_MAX = 121, /* in one that writes and reads */

    MODBUS_REFUSED = 0x80, /* set in the function of an answer that is an exception */
};

enum modbus_function {
    MODBUS_READ = 3,
    MODBUS_READ_INPUTS = 4,
    MODBUS_WRITE_ONE = 6,
    MODBUS_WRITE = 16,
    MODBUS_WRITE_AND_READ = 23,
    MODBUS_IDENTIFY = 43,
};

enum modbus_exception {
    MODBUS_EXCEPTION_NONE = 0,
    MODBUS_EXCEPTION_FUNCTION = 1, /* not known */
    MODBUS_EXCEPTION_ADDRESS = 2,  /* a register, or an object, that is not there or not so */
    MODBUS_EXCEPTION_VALUE = 3,    /* a number, a length, a value */
    MODBUS_EXCEPTION_FAILURE = 4,  /* it was tried and has failed */
    MODBUS_EXCEPTION_BUSY = 6,     /* not while this goes on */
};

/* An answer begins at most so long after the last byte of the request. */
#define MODBUS_PATIENCE_TICKS ((uint64_t)20 * TICKS_PER_MS)

static_assert(MODBUS_ADDRESS_BYTES + 2 + (2 * MODBUS_READ_MAX) + MODBUS_CRC_BYTES <= MODBUS_FRAME_BYTES_MAX,
              "all registers that may be read fit");

#endif
