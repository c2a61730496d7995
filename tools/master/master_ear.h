/*
 * What a master hears: bytes of the line in, one at a time; whole frames out, whoever has sent them.
 *
 * The receiver is that of a unit, to which all of them are frames for others: it judges them and keeps none, and the
 * ear does. Gaps are no error here: adapters and computers make them. 9 kB.
 */
#ifndef MASTER_EAR_H
#define MASTER_EAR_H

#include <stdbool.h>
#include <stdint.h>

#include "link_receiver.h"

struct master_ear {
    struct link_receiver receiver;
    uint32_t length; /* of the last frame: bytes of its message */
    bool escaped;    /* the last byte was an escape */
    uint8_t content[LINK_HEAD_BYTES + LINK_ANSWER_BYTES_MAX + LINK_FCS_BYTES]; /* address, number, message, FCS */
};

/* Has heard nothing. */
void master_ear_init(struct master_ear *ear);

/* Takes one byte. True: it has completed a frame, which stands in `content` until the next byte. */
bool master_ear_take(struct master_ear *ear, uint8_t value);

/* Whether something came that was no whole frame. */
bool master_ear_is_damaged(const struct master_ear *ear);

#endif
