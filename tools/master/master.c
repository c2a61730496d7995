#include "master.h"

#include <string.h>

#include "link_sender.h"
#include "messages.h"

enum stage {
    STAGE_BROADCAST,
    STAGE_OPENING,       /* Version, with a random number */
    STAGE_OPENING_AGAIN, /* and with the next: an old answer can be taken for one of the two, never for both */
    STAGE_ASKING,
    STAGE_SCANNING, /* the answer has come; does another one? */
};

enum {
    NUMBERS = 255,
    BITS_PER_BYTE = 10,
    ENVELOPE_BYTES = 12,
    GAP_MS = 100, /* silence that ends an answer which has begun */
    BROADCAST_PAUSE_MS = 5,
};

#define NS_PER_MS UINT64_C(1000000)
#define NS_PER_S UINT64_C(1000000000)

static const uint8_t opening[] = {LINK_OPENING};

void master_init(struct master *master, uint32_t chance, uint32_t baud, uint32_t usual_ms)
{
    memset(master, 0, sizeof *master);
    master->chance = chance;
    master->usual_ms = usual_ms;
    master->byte_ns = NS_PER_S * BITS_PER_BYTE / baud;
    master->end = MASTER_SILENT;
}

static uint64_t later_of(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

static uint64_t earlier_of(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static bool is_opening(const struct master *master)
{
    return master->stage == STAGE_OPENING || master->stage == STAGE_OPENING_AGAIN;
}

static const uint8_t *sent_message(const struct master *master)
{
    return is_opening(master) ? opening : master->message;
}

static uint32_t sent_length(const struct master *master)
{
    return is_opening(master) ? (uint32_t)sizeof opening : master->order.length;
}

/* Bytes of the longest answer to a message, as noise must not prolong the waiting for ever. */
static uint32_t answer_bytes_max(uint8_t message)
{
    switch ((enum messages_message)message) {
    case MESSAGES_SET_COMMAND:
    case MESSAGES_STORE_FLASH:
    case MESSAGES_UNKNOWN:
        return 4;
    case MESSAGES_GET_PROGRESS:
    case MESSAGES_GET_POSITION:
        return 2 + 4 * 21;
    case MESSAGES_VERSION:
    case MESSAGES_GET_STATUS:
        return 300;
    case MESSAGES_GET_TABLE:
        return 800;
    case MESSAGES_GET_COMMAND:
        break;
    }
    return LINK_ANSWER_BYTES_MAX;
}

static bool changes(uint8_t message)
{
    return message == MESSAGES_SET_COMMAND || message == MESSAGES_STORE_FLASH;
}

static uint32_t patience_ms(const struct master *master)
{
    uint32_t wanted = master->order.patience_ms;
    return is_opening(master) && wanted > master->usual_ms ? master->usual_ms : wanted;
}

static void write_frame(struct master *master)
{
    struct link_sender sender;
    link_sender_start(&sender, master->order.node, master->number, sent_message(master), sent_length(master));
    for (master->out_length = 0; !link_sender_is_done(&sender); link_sender_advance(&sender)) {
        master->out[master->out_length++] = link_sender_byte(&sender);
    }
}

static void begin_attempt(struct master *master, uint64_t now_ns)
{
    uint64_t wait_ms = master->stage == STAGE_BROADCAST ? (uint32_t)BROADCAST_PAUSE_MS : patience_ms(master);
    uint64_t answer_bytes = answer_bytes_max(sent_message(master)[0]) + ENVELOPE_BYTES;
    write_frame(master);
    master_ear_init(&master->ear);
    master->attempt++;
    master->sent_ns = now_ns + master->out_length * master->byte_ns;
    master->until_ns = master->sent_ns + wait_ms * NS_PER_MS;
    master->last_ns = master->until_ns + 2 * answer_bytes * master->byte_ns + GAP_MS * NS_PER_MS;
}

static void begin_frame(struct master *master, enum stage stage, uint8_t number, uint64_t now_ns)
{
    master->stage = (uint8_t)stage;
    master->number = number;
    master->attempt = 0;
    master->echoed = false;
    master->damaged = false;
    begin_attempt(master, now_ns);
}

static void begin_numbered(struct master *master, enum stage stage, uint64_t now_ns)
{
    uint8_t *number = &master->numbers[master->order.node];
    *number = (uint8_t)(*number % NUMBERS + 1U);
    begin_frame(master, stage, *number, now_ns);
}

/* Marsaglia's xorshift32. */
static uint8_t random_number(struct master *master)
{
    uint32_t chance = master->chance;
    chance ^= chance << 13U;
    chance ^= chance >> 17U;
    chance ^= chance << 5U;
    master->chance = chance;
    return (uint8_t)(chance % NUMBERS + 1U);
}

static void begin_session(struct master *master, uint64_t now_ns)
{
    uint8_t node = master->order.node;
    master->numbers[node] = random_number(master);
    master->sessions[node]++;
    begin_numbered(master, STAGE_OPENING, now_ns);
}

void master_ask(struct master *master, const struct master_order *order, uint64_t now_ns)
{
    master->order = *order;
    master->end = MASTER_WAITS;
    master->again = false;
    master->hurried = false;
    master->scans = false;
    master->twice = false;
    master->answer_length = 0;
    if (order->node == LINK_NODE_BROADCAST) {
        begin_frame(master, STAGE_BROADCAST, LINK_NUMBER_NONE, now_ns);
    } else if (!order->in_session) {
        begin_frame(master, STAGE_ASKING, LINK_NUMBER_NONE, now_ns);
    } else if (master->numbers[order->node] == LINK_NUMBER_NONE) {
        begin_session(master, now_ns);
    } else {
        begin_numbered(master, STAGE_ASKING, now_ns);
    }
}

void master_scan(struct master *master, uint8_t node, uint32_t patience_ms, uint32_t attempts, uint64_t now_ns)
{
    const struct master_order order = {
        .node = node, .in_session = true, .length = sizeof opening, .patience_ms = patience_ms, .attempts = attempts};
    memcpy(master->message, opening, sizeof opening);
    master_forget(master, node);
    master_ask(master, &order, now_ns);
    master->scans = true;
}

/* A request with a number that was not answered may be under way yet: the next one begins a session. */
static void end_request(struct master *master, enum master_end end)
{
    master->end = (uint8_t)end;
    if (end != MASTER_ANSWERED && master->number != LINK_NUMBER_NONE) {
        master_forget(master, master->order.node);
    }
}

static void take_refusal(struct master *master, uint64_t now_ns)
{
    if (changes(sent_message(master)[0]) || master->again) {
        end_request(master, master->attempt > 1 ? MASTER_RESTARTED_SENT : MASTER_RESTARTED);
    } else if (master->hurried) {
        end_request(master, MASTER_GIVEN_UP);
    } else {
        master->again = true;
        begin_session(master, now_ns);
    }
}

static bool is_version_asked(const struct master *master)
{
    return master->order.length == sizeof opening && master->message[0] == LINK_OPENING;
}

static void take_last_answer(struct master *master, uint64_t now_ns)
{
    master->answer_length = master->ear.length;
    memcpy(master->answer, master->ear.content + LINK_HEAD_BYTES, master->answer_length);
    if (master->scans) {
        master->stage = STAGE_SCANNING;
        master->until_ns = now_ns + patience_ms(master) * NS_PER_MS;
    } else {
        end_request(master, MASTER_ANSWERED);
    }
}

static void take_answer(struct master *master, uint64_t now_ns)
{
    if (!is_opening(master) || (master->stage == STAGE_OPENING_AGAIN && is_version_asked(master))) {
        take_last_answer(master, now_ns);
    } else if (master->hurried) {
        end_request(master, MASTER_GIVEN_UP);
    } else {
        begin_numbered(master, master->stage == STAGE_OPENING ? STAGE_OPENING_AGAIN : STAGE_ASKING, now_ns);
    }
}

static bool is_echo(const struct master *master)
{
    const struct master_ear *ear = &master->ear;
    return ear->content[0] == master->order.node && ear->length == sent_length(master) &&
           memcmp(ear->content + LINK_HEAD_BYTES, sent_message(master), ear->length) == 0;
}

/* A second unit may be late, and answer the Version before. */
static void take_second_answer(struct master *master)
{
    const uint8_t *content = master->ear.content;
    if (content[0] == (master->order.node | LINK_ADDRESS_ANSWER) && content[LINK_HEAD_BYTES] == LINK_OPENING) {
        master->twice = true;
        end_request(master, MASTER_ANSWERED);
    }
}

/* What of a frame that has come is meant for this request. */
static void take_frame(struct master *master, uint64_t now_ns)
{
    const struct master_ear *ear = &master->ear;
    const uint8_t answers = master->order.node | LINK_ADDRESS_ANSWER;
    const uint8_t message = ear->content[LINK_HEAD_BYTES];
    if (master->stage == STAGE_SCANNING) {
        take_second_answer(master);
    } else if (ear->content[1] != master->number) {
        return;
    } else if (is_echo(master)) {
        master->echoed = true;
        master->echoes = true;
    } else if (ear->content[0] == (answers | LINK_ADDRESS_REFUSED)) {
        take_refusal(master, now_ns);
    } else if (ear->content[0] == answers && (message == sent_message(master)[0] || message == MESSAGES_UNKNOWN)) {
        take_answer(master, now_ns);
    }
}

static bool is_listening(const struct master *master)
{
    return master->end == MASTER_WAITS && master->stage != STAGE_BROADCAST;
}

void master_take(struct master *master, const uint8_t *bytes, uint32_t length, uint64_t now_ns)
{
    uint32_t attempt = master->attempt;
    uint8_t number = master->number;
    for (uint32_t i = 0; i < length && is_listening(master); i++) {
        if (master_ear_take(&master->ear, bytes[i])) {
            take_frame(master, now_ns);
        }
        if (master->attempt != attempt || master->number != number) {
            return; /* the rest came before what has just been sent */
        }
    }
    if (is_listening(master) && master->stage != STAGE_SCANNING && length > 0) {
        uint64_t gap_ns = now_ns + GAP_MS * NS_PER_MS;
        master->until_ns = earlier_of(master->last_ns, later_of(master->until_ns, gap_ns));
    }
}

static enum master_end unanswered(const struct master *master)
{
    if (master->damaged) {
        return MASTER_DAMAGED;
    }
    return master->echoed ? MASTER_ECHOED : MASTER_SILENT;
}

static void end_attempt(struct master *master, uint64_t now_ns)
{
    master->damaged = master->damaged || master_ear_is_damaged(&master->ear);
    if (master->stage == STAGE_BROADCAST || master->stage == STAGE_SCANNING) {
        end_request(master, MASTER_ANSWERED);
    } else if (master->attempt < master->order.attempts && !master->hurried) {
        begin_attempt(master, now_ns);
    } else {
        end_request(master, unanswered(master));
    }
}

enum master_end master_poll(struct master *master, uint64_t now_ns)
{
    if (master->end == MASTER_WAITS && now_ns >= master->until_ns) {
        end_attempt(master, now_ns);
    }
    return (enum master_end)master->end;
}

void master_hurry(struct master *master, uint64_t now_ns)
{
    uint64_t usual_ns = master->sent_ns + master->usual_ms * NS_PER_MS;
    if (!master->hurried) {
        master->hurried = true;
        master->until_ns = earlier_of(master->until_ns, later_of(usual_ns, now_ns + GAP_MS * NS_PER_MS));
    }
}

void master_forget(struct master *master, uint8_t node)
{
    master->numbers[node] = LINK_NUMBER_NONE;
}
