#include "serve_turns.h"

enum {
    LINE_END = '\r',
    NOBODY = -1,
};

#define GAP_NS UINT64_C(1000000000)

void serve_turns_init(struct serve_turns *turns, const struct serve_kind *kind)
{
    turns->kind = kind;
    turns->first = 0;
    turns->count = 0;
    turns->to = NOBODY;
    turns->last = NOBODY;
    turns->inside = false;
    for (unsigned i = 0; i < SERVE_CLIENTS_MAX; i++) {
        serve_turns_begin(turns, i);
    }
}

static struct serve_turn *turn_at(struct serve_turns *turns, uint32_t place)
{
    return &turns->ring[(turns->first + place) % SERVE_TURNS_MAX];
}

static void empty(struct serve_held *held)
{
    held->length = 0;
    held->line = 0;
}

void serve_turns_begin(struct serve_turns *turns, unsigned client)
{
    struct serve_held *held = &turns->held[client];
    empty(held);
    held->goes_on = false;
    held->has_asked = false;
    for (uint32_t i = 0; i < turns->count; i++) {
        struct serve_turn *turn = turn_at(turns, i);
        if (turn->client == (int)client) {
            turn->client = NOBODY;
        }
    }
    turns->to = turns->to == (int)client ? NOBODY : turns->to;
    turns->last = turns->last == (int)client ? NOBODY : turns->last;
}

void serve_turns_forget(struct serve_turns *turns)
{
    turns->count = 0;
}

/* ---- what clients send ---- */

static struct serve_turn pop(struct serve_turns *turns)
{
    struct serve_turn turn = *turn_at(turns, 0);
    turns->first = (turns->first + 1U) % SERVE_TURNS_MAX;
    turns->count--;
    return turn;
}

static void push(struct serve_turns *turns, unsigned client, enum serve_asks asks)
{
    if (turns->count == (uint32_t)SERVE_TURNS_MAX) {
        (void)pop(turns);
    }
    *turn_at(turns, turns->count) = (struct serve_turn){.client = (int8_t)client, .asks = (uint8_t)asks};
    turns->count++;
}

/* True: the request ends with it. */
static bool end_line(struct serve_turns *turns, unsigned client)
{
    struct serve_held *held = &turns->held[client];
    const uint8_t *line = held->bytes + held->line;
    enum serve_asks asks = turns->kind->asks(line, held->length - 1U - held->line, held->goes_on);
    held->line = held->length;
    held->goes_on = asks == SERVE_ASKS_MORE;
    if (asks != SERVE_ASKS_NOTHING && asks != SERVE_ASKS_MORE) {
        held->has_asked = held->has_asked || asks == SERVE_ASKS || asks == SERVE_ASKS_RESET;
        push(turns, client, asks);
    }
    return !held->goes_on;
}

uint32_t serve_turns_take(struct serve_turns *turns, unsigned client, uint8_t byte, uint64_t now_ns)
{
    struct serve_held *held = &turns->held[client];
    if (now_ns - held->at_ns > GAP_NS) {
        empty(held);
        held->goes_on = false;
    }
    held->at_ns = now_ns;
    held->bytes[held->length++] = byte;
    bool is_whole = byte == (uint8_t)LINE_END && end_line(turns, client);
    uint32_t length = held->length;
    if (!is_whole && length < (uint32_t)SERVE_REQUEST_BYTES_MAX) {
        return 0;
    }
    empty(held);
    return length;
}

/* ---- what the unit sends ---- */

/* Whose answer comes next. More than was asked for belongs to who was answered last. */
static int next_client(struct serve_turns *turns, bool resets)
{
    while (resets && turns->count > 1 && turn_at(turns, 0)->asks != (uint8_t)SERVE_ASKS_RESET) {
        (void)pop(turns); /* a reset leaves nothing of what waits before it */
    }
    if (turns->count == 0) {
        return turns->to;
    }
    struct serve_turn turn = pop(turns);
    if (turn.asks == (uint8_t)SERVE_ASKS_AGAIN) {
        bool is_own = turn.client == turns->last || turn.client == NOBODY || !turns->held[turn.client].has_asked;
        return is_own ? turn.client : NOBODY;
    }
    turns->last = turn.asks == (uint8_t)SERVE_ASKS_APART ? turns->last : turn.client;
    return turn.client;
}

int serve_turns_hear(struct serve_turns *turns, uint8_t byte, bool resets)
{
    if (!turns->inside) {
        turns->to = next_client(turns, resets);
    }
    turns->inside = byte != (uint8_t)LINE_END;
    return turns->to;
}
