/*
 * The receiver: bytes from the line in, one at a time; whole frames for this unit out.
 *
 * It knows nothing of what a message means. Of a frame it keeps the message in a buffer of its owner's; frames for
 * others are only checked. A frame that is not whole and right in everything is dropped, counted by the first thing
 * that was wrong, and the next flag begins a new one. Main only. 80 bytes without the buffer.
 */
#ifndef LINK_RECEIVER_H
#define LINK_RECEIVER_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_line.h"
#include "link_frame.h"

/* What the link has seen; the order is that of message 200. X(NAME, text) */
#define LINK_COUNTS(X)                                                                                                 \
    X(FRAMES, "good frames for this unit")                                                                             \
    X(FOREIGN, "good frames for others, and answers")                                                                  \
    X(STRAY, "bytes outside of frames")                                                                                \
    X(BROKEN, "bytes with a framing, noise or overrun error")                                                          \
    X(FCS, "frames with a wrong FCS")                                                                                  \
    X(ABORT, "frames that were aborted")                                                                               \
    X(ESCAPE, "frames with a byte escaped that must not be")                                                           \
    X(SHORT, "frames without a message")                                                                               \
    X(LONG, "frames that were too long")                                                                               \
    X(GAP, "frames with a gap")                                                                                        \
    X(REPEATS, "requests that were not executed again")                                                                \
    X(UNSENT, "answers not begun, as the line was not silent")

enum link_count {
#define X(name, text) LINK_COUNT_##name,
    LINK_COUNTS(X)
#undef X
    LINK_COUNTS_TOTAL
};

/* The room that the receiver needs for a message: the FCS passes through it. */
enum {
    LINK_BUFFER_BYTES = LINK_REQUEST_BYTES_MAX + LINK_FCS_BYTES
};

struct link_receiver {
    uint8_t *message; /* where the message goes: LINK_BUFFER_BYTES */
    uint64_t tick;    /* the end of the last byte of any kind */
    uint32_t bytes;   /* of the frame so far, without flags and escapes, FCS included */
    uint32_t length;  /* after a frame: bytes of its message */
    uint16_t fcs;
    uint8_t state;
    uint8_t node;    /* of this unit, 1 to 16 */
    uint8_t address; /* of the frame so far, or of the last one */
    uint8_t number;
    uint32_t counts[LINK_COUNTS_TOTAL]; /* modulo 2^32; REPEATS and UNSENT are counted by the link */
};

/* Waits for the first flag; all counts are 0. */
void link_receiver_init(struct link_receiver *receiver, uint8_t node, uint8_t *message);

/* Takes one byte. True: it has completed a frame for this unit; address, number, length and message hold until the
 * next byte, the byte's tick is the end of the frame. */
bool link_receiver_take(struct link_receiver *receiver, const struct hal_line_byte *byte);

/* The text of a count, for people. */
const char *link_count_text(enum link_count count);

#endif
