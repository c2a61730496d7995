/*
 * The receiver: bytes of the line in, one at a time; frames out, good ones and bad ones.
 *
 * Silence ends a frame, and only that: T, 3.5 characters up to 19 200 Bd and 1.75 ms above. There is no clock inside.
 * A byte has the tick of its end, so up to a character before that tick all silence is known; who waits says what time
 * it is, and whether a byte may be on its way. Main only. 288 bytes.
 */
#ifndef MODBUS_RECEIVER_H
#define MODBUS_RECEIVER_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_line.h"
#include "modbus_frame.h"

enum modbus_received {
    MODBUS_RECEIVED_NOTHING,
    MODBUS_RECEIVED_FRAME,  /* whole and with the right CRC, to whatever address */
    MODBUS_RECEIVED_BROKEN, /* with a bad byte */
    MODBUS_RECEIVED_LENGTH, /* too short or too long */
    MODBUS_RECEIVED_CRC,    /* with a wrong CRC */
};

struct modbus_receiver {
    uint64_t tick; /* the end of the last byte of any kind; before the first one, the start */
    uint32_t character_ticks;
    uint32_t silence_ticks; /* T */
    uint32_t pause_ticks;   /* a longer silence in a frame is a pause */
    uint16_t length;        /* bytes of the frame so far, or of the last one; at most one more than there is room for */
    uint16_t crc;
    uint8_t state;
    bool broken;                           /* one of its bytes was bad */
    bool paused;                           /* there was a pause in it */
    uint8_t bytes[MODBUS_FRAME_BYTES_MAX]; /* hold from the end of the frame to the next byte */
};

/* Waits for a first silence of T. Of a rate in Bd and the bits of a character, 10 or 11, all times follow. */
void modbus_receiver_init(struct modbus_receiver *receiver, uint32_t rate_bd, uint32_t character_bits,
                          uint64_t start_tick);

/* What silence up to the beginning of this byte means. To be called before modbus_receiver_take. */
enum modbus_received modbus_receiver_wait_byte(struct modbus_receiver *receiver, const struct hal_line_byte *byte);

/* What silence up to this tick means. All bytes that have come must have been taken; quiet: none has begun since. */
enum modbus_received modbus_receiver_wait(struct modbus_receiver *receiver, uint64_t now_ticks, bool quiet);

/* When silence will mean something at the earliest, after this tick has been waited for; TICK_NEVER: not before the
 * next byte. */
uint64_t modbus_receiver_wake(const struct modbus_receiver *receiver, uint64_t now_ticks);

/* Takes one byte. */
void modbus_receiver_take(struct modbus_receiver *receiver, const struct hal_line_byte *byte);

#endif
