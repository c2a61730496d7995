/*
 * The sender: a message in, the bytes of its frame out, one at a time, made on the fly.
 *
 * The message stays where it is and must not change until the frame is done. Main only. 24 bytes.
 */
#ifndef LINK_SENDER_H
#define LINK_SENDER_H

#include <stdbool.h>
#include <stdint.h>

struct link_sender {
    const uint8_t *message;
    uint32_t length; /* bytes of the message */
    uint32_t place;  /* in the frame before escaping: 0 is the opening flag */
    uint16_t fcs;
    uint8_t address;
    uint8_t number;
    bool escaped; /* the escape of the byte at `place` has gone out */
};

/* Nothing to send. */
void link_sender_init(struct link_sender *sender);

/* Begins a frame. */
void link_sender_start(struct link_sender *sender, uint8_t address, uint8_t number, const uint8_t *message,
                       uint32_t length);

/* Whether all bytes have gone out. */
bool link_sender_is_done(const struct link_sender *sender);

/* The byte that is to go out next, as often as asked; and past it. Not when done. */
uint8_t link_sender_byte(const struct link_sender *sender);
void link_sender_advance(struct link_sender *sender);

#endif
