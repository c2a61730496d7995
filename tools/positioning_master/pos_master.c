#include "pos_master.h"

#include <string.h>

enum {
    GAP_HALVES = 7, /* 3.5 characters */
};

#define NS_PER_MS UINT64_C(1000000)
#define NS_PER_S UINT64_C(1000000000)
#define GAP_NS_MIN UINT64_C(1750000)

static uint64_t later_of(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

static uint64_t earlier_of(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

void pos_master_init(struct pos_master *master, uint32_t baud, bool tcp)
{
    memset(master, 0, sizeof *master);
    master->byte_ns = baud > 0U ? NS_PER_S * (uint64_t)POS_MASTER_CHARACTER_BITS / baud : 0U;
    master->gap_ns = tcp ? 0U : later_of(master->byte_ns * (uint64_t)GAP_HALVES / 2U, GAP_NS_MIN);
    master->sent.tcp = tcp;
    master->end = (uint8_t)POS_MASTER_SILENT;
}

/* How long the line is to be silent before something is sent. */
static uint64_t silence_ns(const struct pos_master *master)
{
    return master->owed ? (uint64_t)POS_MASTER_REST_MS * NS_PER_MS : master->gap_ns;
}

static void begin_attempt(struct pos_master *master, uint64_t now_ns)
{
    uint64_t from_ns = master->owed ? now_ns : master->quiet_ns;
    master->listening = false;
    master->out_length = 0;
    master->until_ns = later_of(now_ns, from_ns + silence_ns(master));
    master->last_ns = now_ns + (uint64_t)POS_MASTER_OTHERS_MS_MAX * NS_PER_MS;
}

static bool is_under_way(const struct pos_master *master)
{
    bool waits_to_be_written = master->listening && master->out_length > 0U && master->attempt == 1U;
    return master->end == (uint8_t)POS_MASTER_WAITS && master->attempt > 0U && !waits_to_be_written;
}

void pos_master_ask(struct pos_master *master, const struct pos_master_order *order, uint64_t now_ns)
{
    master->owed = (master->owed || is_under_way(master)) && !master->sent.tcp;
    master->order = *order;
    master->end = (uint8_t)POS_MASTER_WAITS;
    master->attempt = 0;
    begin_attempt(master, now_ns);
}

static void send_request(struct pos_master *master, uint64_t now_ns)
{
    const struct pos_master_order *order = &master->order;
    bool broadcast = order->node == (uint8_t)MODBUS_ADDRESS_BROADCAST;
    uint64_t wait_ms = order->patience_ms + pos_master_more_ms(master->request, order->length);
    master->number = (uint16_t)(master->number % UINT16_MAX + 1U);
    pos_master_frame_make(&master->sent, order->node, master->number, master->request, order->length);
    pos_master_ear_init(&master->ear);
    master->attempt++;
    master->listening = true;
    master->owed = false;
    master->out_length = master->sent.length;
    uint64_t sent_ns = now_ns + master->sent.length * master->byte_ns;
    master->until_ns = sent_ns + (broadcast ? (uint64_t)POS_MASTER_TURN_MS : wait_ms) * NS_PER_MS;
    master->last_ns = master->until_ns + (uint64_t)MODBUS_FRAME_BYTES_MAX * master->byte_ns +
                      (uint64_t)POS_MASTER_OTHERS_MS_MAX * NS_PER_MS;
}

/* After what is damaged the line has rested; else an answer may be late yet. */
static void fail_attempt(struct pos_master *master, enum pos_master_end end, uint64_t now_ns)
{
    master->owed = end != POS_MASTER_DAMAGED && !master->sent.tcp;
    if (master->attempt < master->order.attempts) {
        begin_attempt(master, now_ns);
    } else {
        master->end = (uint8_t)end;
    }
}

static enum pos_master_end unanswered(const struct pos_master *master)
{
    if (!pos_master_ear_is_whole(&master->ear)) {
        return POS_MASTER_DAMAGED;
    }
    return master->ear.echo > 0U ? POS_MASTER_ECHOED : POS_MASTER_SILENT;
}

static void take_answer(struct pos_master *master, uint64_t now_ns)
{
    const uint8_t *answer = pos_master_answer(master);
    bool refused = (answer[0] & (uint8_t)MODBUS_REFUSED) != 0U;
    if (refused && answer[1] == (uint8_t)POS_MASTER_AWAY) {
        fail_attempt(master, POS_MASTER_ABSENT, now_ns);
        return;
    }
    master->owed = master->attempt > 1U && !master->sent.tcp;
    master->end = (uint8_t)(refused ? POS_MASTER_REFUSED : POS_MASTER_ANSWERED);
}

/* Noise, or an answer that has begun: soon after its last byte it is over. What may be an echo, or comes from a
 * gateway, leaves the unit its time. */
static void wait_for_rest(struct pos_master *master, uint64_t now_ns)
{
    const struct pos_master_ear *ear = &master->ear;
    if (pos_master_ear_is_whole(ear)) {
        return;
    }
    uint64_t until_ns = now_ns + (uint64_t)POS_MASTER_REST_MS * NS_PER_MS + ear->length * master->byte_ns;
    if (master->sent.tcp || pos_master_ear_may_be_echo(ear, &master->sent)) {
        until_ns = later_of(until_ns, master->until_ns);
    }
    master->until_ns = earlier_of(until_ns, master->last_ns);
}

static void listen(struct pos_master *master, const uint8_t *bytes, uint32_t length, uint64_t now_ns)
{
    for (uint32_t i = 0; i < length; i++) {
        if (pos_master_ear_take(&master->ear, &master->sent, bytes[i])) {
            take_answer(master, now_ns);
            return; /* the rest is no answer to this request */
        }
    }
    wait_for_rest(master, now_ns);
}

void pos_master_take(struct pos_master *master, const uint8_t *bytes, uint32_t length, uint64_t now_ns)
{
    if (length == 0U) {
        return;
    }
    master->quiet_ns = now_ns;
    if (master->end != (uint8_t)POS_MASTER_WAITS) {
        return;
    }
    if (!master->listening) {
        uint64_t silent_ns = later_of(master->until_ns, now_ns + silence_ns(master));
        master->until_ns = earlier_of(silent_ns, master->last_ns);
    } else if (master->order.node != (uint8_t)MODBUS_ADDRESS_BROADCAST) {
        listen(master, bytes, length, now_ns);
    }
}

static void end_attempt(struct pos_master *master, uint64_t now_ns)
{
    if (master->order.node == (uint8_t)MODBUS_ADDRESS_BROADCAST) {
        master->end = (uint8_t)POS_MASTER_ANSWERED;
    } else {
        fail_attempt(master, unanswered(master), now_ns);
    }
}

enum pos_master_end pos_master_poll(struct pos_master *master, uint64_t now_ns)
{
    if (master->end == (uint8_t)POS_MASTER_WAITS && now_ns >= master->until_ns) {
        if (master->listening) {
            end_attempt(master, now_ns);
        } else {
            send_request(master, now_ns);
        }
    }
    return (enum pos_master_end)master->end;
}

const uint8_t *pos_master_answer(const struct pos_master *master)
{
    return master->ear.heard + master->ear.answer_at;
}

uint32_t pos_master_answer_length(const struct pos_master *master)
{
    return master->ear.answer_length;
}
