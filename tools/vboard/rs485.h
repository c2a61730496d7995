/*
 * The line outside the unit: a half-duplex RS-485 bus at the transceiver of one USART. What a script or a client says
 * comes in byte by byte in virtual time; what the unit says goes out if its driver was on all the while. While the
 * unit drives the bus it hears nothing.
 *
 * A script has lines `ms bytes`: the time at which the first start bit begins, and bytes in hexadecimal, back to back,
 * blanks between them or not. Behind a byte, `*` makes its stop bit wrong (framing error) and `~` makes it noisy.
 */
#ifndef RS485_H
#define RS485_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "outfile.h"

struct board;

struct rs485_byte {
    uint64_t start_ps; /* not before */
    uint8_t value;
    uint8_t damage; /* set of enum usart_damage */
};

struct rs485 {
    struct rs485_byte *byte; /* to come, in order */
    size_t bytes;
    size_t room;
    size_t next;
    bool arriving;  /* byte[next] is on the bus */
    bool disturbed; /* while the unit's driver was on */
    uint64_t arrival_ps;
    uint64_t free_ps; /* the bus is free for the next byte */
    bool sending;     /* the unit sends a byte */
    bool driven_throughout;
    uint64_t sent_end_cycle; /* of the last byte that the unit sent */
    uint64_t sent;           /* bytes that reached the bus */
    uint64_t unheard;        /* that the unit sent with its driver off, cut short, or not connected */
    uint64_t heard;          /* bytes of others that arrived at the USART */
    uint64_t collisions;
    uint64_t release_most_ps; /* from the end of a byte to the driver being off */
    struct outfile log;
};

/* Reads the script and opens the log. False after a complaint. */
bool rs485_open(struct board *board);
bool rs485_close(struct board *board);
void rs485_discard(struct board *board);

/* Puts a byte onto the bus as soon as it is free. */
void rs485_say(struct board *board, uint8_t value);

void rs485_event(struct board *board, uint64_t cycle);

/* The unit begins or ends a byte; its driver goes on or off. */
void rs485_begin_sent(struct board *board, unsigned usart, uint64_t cycle);
void rs485_end_sent(struct board *board, unsigned usart, uint8_t value, bool connected, uint64_t begin_cycle,
                    uint64_t cycle);
void rs485_note_driver(struct board *board, bool on, uint64_t cycle);

#endif
