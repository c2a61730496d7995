/*
 * What a master sends: a request from its function on, in a frame of Modbus RTU or of Modbus TCP. Pure.
 */
#ifndef POS_MASTER_FRAME_H
#define POS_MASTER_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "modbus_frame.h"

enum {
    POS_MASTER_STORE_MS = 2200, /* 2 s are the unit's */
    POS_MASTER_REQUEST_BYTES_MAX = MODBUS_FRAME_BYTES_MAX - MODBUS_ADDRESS_BYTES - MODBUS_CRC_BYTES,

    /* number | 0 | length of what follows | address | function ..., the first three of two bytes each */
    POS_MASTER_TCP_AT_LENGTH = 4,
    POS_MASTER_TCP_AT_NODE = 6,
    POS_MASTER_TCP_HEAD_BYTES = 7,
    POS_MASTER_SENT_BYTES_MAX = POS_MASTER_TCP_HEAD_BYTES + POS_MASTER_REQUEST_BYTES_MAX,
};

struct pos_master_frame {
    uint32_t length;
    bool tcp;
    uint8_t bytes[POS_MASTER_SENT_BYTES_MAX];
};

/* Puts the CRC after `length` bytes, for which there is room. Returns the length of the frame. */
uint32_t pos_master_seal(uint8_t *frame, uint32_t length);

/* Makes the frame of a request of 1 to POS_MASTER_REQUEST_BYTES_MAX bytes; `number` counts in Modbus TCP alone. */
void pos_master_frame_make(struct pos_master_frame *frame, uint8_t node, uint16_t number, const uint8_t *request,
                           uint32_t length);

/* How much longer than others the answer to a request may take to begin: POS_MASTER_STORE_MS if it writes STORE, or 0.
 */
uint32_t pos_master_more_ms(const uint8_t *request, uint32_t length);

#endif
