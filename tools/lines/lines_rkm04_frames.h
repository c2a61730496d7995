/*
 * Frames by themselves, for those that make or read bytes of a line and are not its master: records of a line, and
 * what is played to a board. For tools in Python, by the shared library rkm04-lines.
 */
#ifndef LINES_RKM04_FRAMES_H
#define LINES_RKM04_FRAMES_H

#include <stdbool.h>
#include <stdint.h>

#include "lines_shared.h"

struct lines_rkm04_ear;

/* The most bytes of the frame of a message. */
LINES_SHARED uint32_t lines_rkm04_frame_bytes_max(uint32_t message_length);

/* Writes the frame of a message, flags included, into room for so many bytes; returns its length. */
LINES_SHARED uint32_t lines_rkm04_frame_write(uint8_t *frame, uint8_t address, uint8_t number, const uint8_t *message,
                                              uint32_t length);

/* Has heard nothing. Null: there is not memory enough. */
LINES_SHARED struct lines_rkm04_ear *lines_rkm04_ear_begin(void);

/* Null is fine. */
LINES_SHARED void lines_rkm04_ear_end(struct lines_rkm04_ear *ear);

/* Takes bytes until one has completed a frame, or all of them; returns how many it has taken. */
LINES_SHARED uint32_t lines_rkm04_ear_take(struct lines_rkm04_ear *ear, const uint8_t *bytes, uint32_t length);

/* Of the frame that the last byte has completed: address, number and message; so many bytes, 0: there is none. */
LINES_SHARED const uint8_t *lines_rkm04_ear_content(const struct lines_rkm04_ear *ear);
LINES_SHARED uint32_t lines_rkm04_ear_length(const struct lines_rkm04_ear *ear);

/* Whether something came that was no whole frame, or is none yet. */
LINES_SHARED bool lines_rkm04_ear_is_damaged(const struct lines_rkm04_ear *ear);

#endif
