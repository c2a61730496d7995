/*
 * The receiver: bytes of the line in, one at a time; whole lines for the unit's two addresses out, or that one was
 * damaged.
 *
 * It knows the frame of a line (line.md, "A request") and when one is damaged ("Damage"), nothing of commands. Its
 * owner tells it whether checksums are on and whether a packet is being received, as both change what damage is. There
 * is no clock inside: a byte has the tick of its end, and who waits calls gve_receiver_poll. Main only. 104 bytes.
 */
#ifndef GVE_RECEIVER_H
#define GVE_RECEIVER_H

#include <stdbool.h>
#include <stdint.h>

#include "../command/gve_command.h"
#include "hal_line.h"

enum {
    GVE_LINE_CHARACTERS_MAX = 80, /* between ! and CR */
    GVE_LINE_END = '\r',
};

enum gve_received {
    GVE_RECEIVED_NOTHING,
    GVE_RECEIVED_LINE,   /* `text` is a command, to `address` */
    GVE_RECEIVED_DAMAGE, /* to be answered once: outside a packet a command, or the packet has ended without its end */
    GVE_RECEIVED_BAD_LINE, /* a command of the packet was damaged; the packet goes on */
};

struct gve_receiver {
    uint64_t tick;     /* the end of the last byte of any kind */
    uint8_t digits[2]; /* the addresses of the interpolator and of the spindle, as characters */
    bool sums;         /* owner: commands have checksums */
    bool packet;       /* owner sets it at the begin and clears it at the end of a packet */
    bool owes;         /* what is being thrown away will be answered */
    bool too_long;     /* more characters came than there is room for; set with a line, too */
    uint8_t state;
    uint8_t address;                       /* of the line: enum gve_address; 0: of another unit, or not known yet */
    uint8_t count;                         /* characters of the line so far */
    uint8_t length;                        /* after a line: of `text` */
    uint8_t sum;                           /* of them and the !, modulo 256 */
    uint8_t line[GVE_LINE_CHARACTERS_MAX]; /* from the address on */
};

/* Waits for the first line; sums are off, no packet. The addresses are 0 to 7 and differ. */
void gve_receiver_init(struct gve_receiver *receiver, unsigned interpolator, unsigned spindle);

/* What silence up to this tick means. To be called before each byte with its tick. */
enum gve_received gve_receiver_poll(struct gve_receiver *receiver, uint64_t now_ticks);

/* When silence will mean something at the earliest; TICK_NEVER: not before the next byte. */
uint64_t gve_receiver_wake(const struct gve_receiver *receiver);

/* Takes one byte. A line and its text hold until the next one. */
enum gve_received gve_receiver_take(struct gve_receiver *receiver, const struct hal_line_byte *byte);

/* Takes bytes that came at one tick, none of them broken, up to one with which something is received. *next goes past
 * what was taken; `end` is the end of all. A line and its text hold until the next byte. */
enum gve_received gve_receiver_take_run(struct gve_receiver *receiver, const uint8_t **next, const uint8_t *end,
                                        uint64_t tick_ticks);

/* The text of a line: the command without its address and its checksum. */
const uint8_t *gve_receiver_text(const struct gve_receiver *receiver);

/* The owner has no room for what came outside a packet: all is thrown away up to a silence, and then answered once. */
void gve_receiver_refuse(struct gve_receiver *receiver);

#endif
