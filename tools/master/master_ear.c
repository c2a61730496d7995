#include "master_ear.h"

enum {
    NODE_OF_NOBODY = 0x1F /* 17 to 31 are no addresses of units */
};

static_assert((unsigned)NODE_OF_NOBODY > (unsigned)LINK_NODE_MAX, "nothing may be for the ear itself");

void master_ear_init(struct master_ear *ear)
{
    /* What goes to all units the receiver keeps itself: at the same place. */
    link_receiver_init(&ear->receiver, NODE_OF_NOBODY, ear->content + LINK_HEAD_BYTES);
    ear->length = 0;
    ear->escaped = false;
}

bool master_ear_take(struct master_ear *ear, uint8_t value)
{
    struct link_receiver *receiver = &ear->receiver;
    const struct hal_line_byte byte = {.value = value}; /* always the same tick: no gaps */
    uint32_t bytes = receiver->bytes;
    uint32_t foreign = receiver->counts[LINK_COUNT_FOREIGN];
    bool good = link_receiver_take(receiver, &byte) || receiver->counts[LINK_COUNT_FOREIGN] != foreign;
    if (receiver->bytes > bytes) {
        ear->content[bytes] = ear->escaped ? value ^ LINK_ESCAPED : value;
    }
    ear->escaped = value == LINK_ESCAPE;
    if (good) {
        ear->length = bytes - LINK_HEAD_BYTES - LINK_FCS_BYTES;
    }
    return good;
}

bool master_ear_is_damaged(const struct master_ear *ear)
{
    const struct link_receiver *receiver = &ear->receiver;
    uint32_t dropped = receiver->bytes; /* of a frame that was begun and not ended */
    for (unsigned i = LINK_COUNT_STRAY; i <= LINK_COUNT_GAP; i++) {
        dropped |= receiver->counts[i];
    }
    return dropped != 0;
}
