/*
 * What a master hears after it has sent a request: bytes in, one at a time; the answer out, wherever it stands among
 * them.
 *
 * What else is whole, an echo of the request or a frame of others, is known from what is damaged. Pauses are no error
 * here, as adapters and computers make them: the length of an answer follows from its function. 530 bytes.
 */
#ifndef POS_MASTER_EAR_H
#define POS_MASTER_EAR_H

#include <stdbool.h>
#include <stdint.h>

#include "pos_master_frame.h"

enum {
    POS_MASTER_EAR_BYTES = 2 * POS_MASTER_SENT_BYTES_MAX
};

struct pos_master_ear {
    uint32_t length; /* bytes in `heard` */
    uint32_t whole;  /* of these belong to whole frames */
    uint32_t echo;   /* of these are the request itself */
    uint32_t answer_at;
    uint32_t answer_length; /* from the function on, without CRC */
    uint16_t crc;           /* of what follows the whole ones */
    bool loose;             /* there were bytes before these, and not all of them belonged to whole frames */
    uint8_t heard[POS_MASTER_EAR_BYTES];
};

/* Has heard nothing. */
void pos_master_ear_init(struct pos_master_ear *ear);

/* Takes a byte that has come after `sent`. True: it has completed the answer, which stands in `heard` until the next
 * byte. The echo of MODBUS_WRITE_ONE is taken for its answer, as these are the same. */
bool pos_master_ear_take(struct pos_master_ear *ear, const struct pos_master_frame *sent, uint8_t byte);

/* Whether all that came is, or may become, whole frames that are not the answer; true as well of nothing. */
bool pos_master_ear_is_whole(const struct pos_master_ear *ear);
bool pos_master_ear_may_be_echo(const struct pos_master_ear *ear, const struct pos_master_frame *sent);

#endif
