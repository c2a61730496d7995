/*
 * The frame: what encloses a message on the line (line.md, "The frame"). Constants only.
 *
 *     7E | address | number | message | FCS low | FCS high | 7E
 */
#ifndef LINK_FRAME_H
#define LINK_FRAME_H

#include <assert.h>
#include <stdint.h>

#include "base_tick.h"

enum {
    LINK_FLAG = 0x7E,   /* opens and closes a frame; may do both at once */
    LINK_ESCAPE = 0x7D, /* the next byte is a flag or an escape, with LINK_ESCAPED changed */
    LINK_ESCAPED = 0x20,

    LINK_ADDRESS_ANSWER = 0x80,  /* set in the address of an answer */
    LINK_ADDRESS_REFUSED = 0x40, /* set too: not executed, as no session is open */
    LINK_NODE_BROADCAST = 0,     /* all units; none answers */
    LINK_NODE_MAX = 16,

    LINK_NUMBER_NONE = 0, /* the request is executed whenever it comes */
    LINK_OPENING = 1,     /* the message that opens a session: Version; and all of a refusal */

    LINK_HEAD_BYTES = 2, /* address and number */
    LINK_FCS_BYTES = 2,

    /* Bytes of a message; the least is 1. */
#ifdef RKM04_TINY_LIMITS
    LINK_REQUEST_BYTES_MAX = 40,
#else
    LINK_REQUEST_BYTES_MAX = 8192,
#endif
    LINK_ANSWER_BYTES_MAX = 8402, /* Get Command of 700 longest commands */
};

static_assert((uint32_t)LINK_REQUEST_BYTES_MAX <= (uint32_t)LINK_ANSWER_BYTES_MAX, "a foreign frame may be longer");

/* The longest way from the end of one byte of a frame to the end of the next, flags included. */
#define LINK_GAP_TICKS ((uint64_t)50 * TICKS_PER_MS)

/* An answer begins when the line has been silent for the first time, but no later than the second after it is ready. */
#define LINK_SILENCE_TICKS ((uint64_t)1 * TICKS_PER_MS)
#define LINK_PATIENCE_TICKS ((uint64_t)20 * TICKS_PER_MS)

#endif
