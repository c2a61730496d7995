#include "link.h"

#include "base_crc32.h"

void link_init(struct link *link, uint8_t node, const uint8_t *answer)
{
    link_receiver_init(&link->receiver, node, link->message);
    link_sender_init(&link->sender);
    link->answer = answer;
    link->open = false;
    link_forget(link);
}

/* Only such a request may be a repeat. */
static bool is_numbered(const struct link_receiver *receiver)
{
    return (receiver->address != LINK_NODE_BROADCAST) && (receiver->number != LINK_NUMBER_NONE);
}

static bool is_repeat(const struct link *link)
{
    const struct link_receiver *receiver = &link->receiver;
    return is_numbered(receiver) && receiver->number == link->answered_number &&
           receiver->length == link->answered_length &&
           crc32_append(0, receiver->message, receiver->length) == link->answered_crc;
}

/* The answer is to be sent from now on. */
static void ready_answer(struct link *link)
{
    link->waiting = true;
    link->ready_tick = TICK_NEVER;
}

static void link_count(struct link *link, enum link_count count)
{
    link->receiver.counts[count]++;
}

/* A numbered request may be the repeat of one that was executed before the unit started. So none is executed until the
 * master has opened a session. */
static bool is_refused(struct link *link)
{
    bool numbered = is_numbered(&link->receiver);
    if (numbered && link->receiver.message[0] == LINK_OPENING) {
        link->open = true;
    }
    return numbered && !link->open;
}

bool link_take(struct link *link, const struct hal_line_byte *byte, struct link_request *request)
{
    const struct link_receiver *receiver = &link->receiver;
    if (!link_receiver_take(&link->receiver, byte)) {
        return false;
    }
    if (link->waiting) {
        link_count(link, LINK_COUNT_UNSENT);
        link->waiting = false;
    }
    if (is_repeat(link)) {
        link_count(link, LINK_COUNT_REPEATS);
    } else if (is_refused(link)) {
        link->answer_number = receiver->number;
    } else {
        *request = (struct link_request){
            .message = receiver->message,
            .length = receiver->length,
            .end_tick = byte->tick,
            .broadcast = receiver->address == LINK_NODE_BROADCAST,
        };
        return true;
    }
    ready_answer(link);
    return false;
}

void link_answer(struct link *link, uint32_t length)
{
    link->answer_length = length;
    link->answer_number = link->receiver.number;
    link->answered_number = link->receiver.number;
    link->answered_length = link->receiver.length;
    link->answered_crc = crc32_append(0, link->receiver.message, link->receiver.length);
    ready_answer(link);
}

uint32_t link_kept_bytes(const struct link *link)
{
    return link->answered_number == LINK_NUMBER_NONE ? 0 : link->answer_length;
}

void link_forget(struct link *link)
{
    link->waiting = false;
    link->answered_number = LINK_NUMBER_NONE;
}

/* As nothing numbered is executed without a session, an answer with a number is the refusal. */
static void begin_answer(struct link *link)
{
    static const uint8_t refusal[] = {LINK_OPENING};
    uint8_t address = link->receiver.node | LINK_ADDRESS_ANSWER;
    if (link->open || (link->answer_number == LINK_NUMBER_NONE)) {
        link_sender_start(&link->sender, address, link->answer_number, link->answer, link->answer_length);
    } else {
        link_sender_start(&link->sender, address | LINK_ADDRESS_REFUSED, link->answer_number, refusal, sizeof refusal);
    }
}

uint64_t link_poll(struct link *link, uint64_t now_ticks)
{
    uint64_t begin = link->receiver.tick + LINK_SILENCE_TICKS;
    if (!link->waiting) {
        return TICK_NEVER;
    }
    if (now_ticks < link->ready_tick) {
        link->ready_tick = now_ticks;
    }
    if (now_ticks < begin) {
        return begin;
    }
    link->waiting = false;
    if (now_ticks > link->ready_tick + LINK_PATIENCE_TICKS) {
        link_count(link, LINK_COUNT_UNSENT);
        return TICK_NEVER;
    }
    begin_answer(link);
    return TICK_NEVER;
}

bool link_is_sending(const struct link *link)
{
    return !link_sender_is_done(&link->sender);
}

uint8_t link_byte(const struct link *link)
{
    return link_sender_byte(&link->sender);
}

void link_advance(struct link *link)
{
    link_sender_advance(&link->sender);
}
