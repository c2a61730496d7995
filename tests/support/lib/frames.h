/*
 * Frames of the line as a master makes them, by means of its own: nothing here is the unit's.
 */
#ifndef FRAMES_H
#define FRAMES_H

#include <stdint.h>

/* The longest frame of a message of so many bytes: every byte escaped, and the flags. */
#define FRAME_BYTES_MAX(message_bytes) (2 * (2 + (message_bytes) + 2) + 2)

/* Writes a frame, flags included, and returns its length. */
uint32_t frame_write(uint8_t *frame, uint8_t address, uint8_t number, const void *message, uint32_t length);

/* Reads a frame, flags included, back to what lies between them without the FCS: address, number, message. Returns its
 * length; 0: it is no whole frame. */
uint32_t frame_read(uint8_t *content, const uint8_t *frame, uint32_t length);

#endif
