#include "link_receiver.h"

#include "link_fcs.h"

enum state {
    STATE_OUTSIDE, /* no flag has come yet, or none for long */
    STATE_DROPPED, /* the rest of a frame that is not wanted, until the next flag */
    STATE_INSIDE,  /* after a flag */
    STATE_ESCAPED, /* after an escape in a frame */
};

enum {
    FRAME_BYTES_MIN = LINK_HEAD_BYTES + 1 + LINK_FCS_BYTES,
    REQUEST_FRAME_BYTES_MAX = LINK_HEAD_BYTES + LINK_REQUEST_BYTES_MAX + LINK_FCS_BYTES,
    ANSWER_FRAME_BYTES_MAX = LINK_HEAD_BYTES + LINK_ANSWER_BYTES_MAX + LINK_FCS_BYTES,
};

void link_receiver_init(struct link_receiver *receiver, uint8_t node, uint8_t *message)
{
    *receiver = (struct link_receiver){.node = node, .message = message, .state = STATE_OUTSIDE};
}

static void receiver_count(struct link_receiver *receiver, enum link_count count)
{
    receiver->counts[count]++;
}

static void receiver_drop(struct link_receiver *receiver, enum link_count cause)
{
    receiver_count(receiver, cause);
    receiver->state = STATE_DROPPED;
}

static bool is_for_us(const struct link_receiver *receiver)
{
    return receiver->address == receiver->node || receiver->address == LINK_NODE_BROADCAST;
}

/* A flag that has been standing alone for long opens nothing: nobody sends a flag and then waits. */
static void watch_gap(struct link_receiver *receiver, uint64_t tick)
{
    bool open = receiver->state == STATE_INSIDE || receiver->state == STATE_ESCAPED;
    if (!open || tick - receiver->tick <= LINK_GAP_TICKS) {
        return;
    }
    if (receiver->bytes == 0 && receiver->state == STATE_INSIDE) {
        receiver->state = STATE_OUTSIDE;
    } else {
        receiver_drop(receiver, LINK_COUNT_GAP);
    }
}

/* The frame that ends here, with a flag: is it one for this unit? */
static bool judge_frame(struct link_receiver *receiver)
{
    if (receiver->state == STATE_ESCAPED) {
        receiver_count(receiver, LINK_COUNT_ABORT);
    } else if (receiver->state != STATE_INSIDE || receiver->bytes == 0) {
        return false;
    } else if (receiver->bytes < FRAME_BYTES_MIN) {
        receiver_count(receiver, LINK_COUNT_SHORT);
    } else if (receiver->fcs != LINK_FCS_GOOD) {
        receiver_count(receiver, LINK_COUNT_FCS);
    } else if (!is_for_us(receiver)) {
        receiver_count(receiver, LINK_COUNT_FOREIGN);
    } else {
        receiver_count(receiver, LINK_COUNT_FRAMES);
        receiver->length = receiver->bytes - LINK_HEAD_BYTES - LINK_FCS_BYTES;
        return true;
    }
    return false;
}

static bool take_flag(struct link_receiver *receiver)
{
    bool good = judge_frame(receiver);
    receiver->state = STATE_INSIDE;
    receiver->bytes = 0;
    receiver->fcs = LINK_FCS_START;
    return good;
}

/* Takes a byte of a frame as it was before escaping. */
static void take_plain(struct link_receiver *receiver, uint8_t value)
{
    uint32_t place = receiver->bytes;
    if (place == 0) {
        receiver->address = value;
    }
    if (place == (uint32_t)(is_for_us(receiver) ? REQUEST_FRAME_BYTES_MAX : ANSWER_FRAME_BYTES_MAX)) {
        receiver_drop(receiver, LINK_COUNT_LONG);
        return;
    }
    if (place == 1) {
        receiver->number = value;
    } else if (place >= LINK_HEAD_BYTES && is_for_us(receiver)) {
        receiver->message[place - LINK_HEAD_BYTES] = value;
    }
    receiver->fcs = link_fcs_append(receiver->fcs, value);
    receiver->bytes = place + 1U;
    receiver->state = STATE_INSIDE;
}

static void take_escaped(struct link_receiver *receiver, uint8_t value)
{
    uint8_t plain = value ^ LINK_ESCAPED;
    if (plain == LINK_FLAG || plain == LINK_ESCAPE) {
        take_plain(receiver, plain);
    } else {
        receiver_drop(receiver, LINK_COUNT_ESCAPE);
    }
}

static void take_value(struct link_receiver *receiver, uint8_t value)
{
    switch ((enum state)receiver->state) {
    case STATE_OUTSIDE:
        receiver_count(receiver, LINK_COUNT_STRAY);
        break;
    case STATE_DROPPED:
        break;
    case STATE_INSIDE:
        if (value == LINK_ESCAPE) {
            receiver->state = STATE_ESCAPED;
        } else {
            take_plain(receiver, value);
        }
        break;
    case STATE_ESCAPED:
        take_escaped(receiver, value);
        break;
    }
}

bool link_receiver_take(struct link_receiver *receiver, const struct hal_line_byte *byte)
{
    watch_gap(receiver, byte->tick);
    receiver->tick = byte->tick;
    if (byte->broken) {
        receiver_drop(receiver, LINK_COUNT_BROKEN);
        return false;
    }
    if (byte->value == LINK_FLAG) {
        return take_flag(receiver);
    }
    take_value(receiver, byte->value);
    return false;
}

const char *link_count_text(enum link_count count)
{
    static const char *const texts[] = {
#define X(name, text) [LINK_COUNT_##name] = (text),
        LINK_COUNTS(X)
#undef X
    };
    return texts[count];
}
