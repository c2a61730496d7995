/*
 * The line outside the unit: a half-duplex RS-485 bus at the transceiver of one USART. What a script or a client says
 * comes in byte by byte in virtual time, and bit by bit at the pin of the receiver; what the unit says goes out if its
 * driver was on all the while. While the unit drives the bus it hears nothing.
 *
 * A script has lines `ms bytes`: the time at which the first start bit begins, and bytes in hexadecimal, back to back,
 * blanks between them or not. After a byte, `*` makes its stop bit wrong (framing error), `!` its parity, and `~`
 * makes it noisy.
 */
#ifndef RS485_H
#define RS485_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "clock.h"
#include "outfile.h"
#include "pins.h"
#include "usart.h"

struct rs485_byte {
    uint64_t start_ps; /* not before */
    uint8_t value;
    uint8_t damage; /* set of enum usart_damage */
};

/* Who else hears what the unit says; null: nobody. */
struct rs485_listener {
    void *model;
    void (*hear)(void *model, uint8_t value);
};

struct rs485_wires {
    struct clock *clock;
    const struct pins *pins;
    struct usart *usart; /* of the line */
    struct rs485_listener listener;
    uint64_t baud;
    enum usart_format format;
};

struct rs485 {
    struct rs485_wires wires;
    struct rs485_byte *byte; /* to come, in order */
    size_t bytes;
    size_t room;
    size_t next;
    bool arriving;  /* byte[next] is on the bus */
    unsigned bit;   /* of it, that is to be shown next; after the first stop bit: none */
    bool disturbed; /* while the unit's driver was on */
    uint64_t arrival_ps;
    uint64_t free_ps; /* the bus is free for the next byte */
    bool driver_on;
    bool sending; /* the unit sends a byte */
    bool driven_throughout;
    uint64_t sent_end_cycle; /* of the last byte that the unit sent */
    uint64_t sent;           /* bytes that reached the bus */
    uint64_t unheard;        /* that the unit sent with its driver off, cut short, or not connected */
    uint64_t breaks;         /* how often the transmitter held the bus low before it was on */
    uint64_t heard;          /* bytes of others that arrived at the USART */
    uint64_t collisions;
    uint64_t release_most_ps; /* from the end of a byte to the driver being off */
    struct outfile log;
};

void rs485_init(struct rs485 *line, struct rs485_wires wires);

/* Reads the script and opens the log; null for none. False after a complaint. */
bool rs485_open(struct rs485 *line, const char *script, const char *log);
bool rs485_close(struct rs485 *line);
void rs485_discard(struct rs485 *line);

/* Puts a byte onto the bus as soon as it is free. */
void rs485_say(struct rs485 *line, uint8_t value);

/* The driver of the unit goes on or off. */
void rs485_note_driver(struct rs485 *line, bool on, uint64_t cycle);

#endif
