#include "gve_wire.h"

#include <assert.h>
#include <string.h>

enum {
    BITS_PER_BYTE = 10,
    GAP_MS = 100, /* within an answer: what adapters make of it */
    CUT_MS = 30,
    BARE_INDEX_BYTES_MIN = 3,
    BARE_INDEX_BYTES_MAX = 5,
};

#define NS_PER_S UINT64_C(1000000000)

static_assert((unsigned)GVE_WIRE_TEXT_BYTES >= 128U * sizeof "C-2147483647,-2147483647,-2147483647,-2147483647",
              "a packet fits that fills the queue");

static uint64_t later_of(uint64_t one_ns, uint64_t other_ns)
{
    return one_ns > other_ns ? one_ns : other_ns;
}

static uint64_t earlier_of(uint64_t one_ns, uint64_t other_ns)
{
    return one_ns < other_ns ? one_ns : other_ns;
}

void gve_wire_init(struct gve_wire *wire, uint32_t baud)
{
    memset(wire, 0, sizeof *wire);
    wire->byte_ns = (BITS_PER_BYTE * NS_PER_S + baud - 1) / baud;
    wire->sums = true;
    wire->over = true;
}

static void begin_out(struct gve_wire *wire)
{
    memset(&wire->heard, 0, sizeof wire->heard);
    text_init(&wire->sent, wire->out, sizeof wire->out);
    wire->out_length = 0;
}

void gve_wire_begin(struct gve_wire *wire, uint64_t now_ns)
{
    if (wire->length > 0) {
        wire->cut_ns = now_ns + CUT_MS * GVE_WIRE_NS_PER_MS;
    }
    wire->length = 0;
    begin_out(wire);
}

void gve_wire_put(struct gve_wire *wire, const uint8_t *text, uint32_t length, bool sums)
{
    gve_reply_put_command(&wire->sent, text, length, sums);
    wire->out_length = wire->sent.length;
}

void gve_wire_put_beside(struct gve_wire *wire, const char *text)
{
    begin_out(wire);
    gve_wire_put(wire, (const uint8_t *)text, (uint32_t)strlen(text), wire->sums);
}

void gve_wire_listen(struct gve_wire *wire, enum gve_listening listening, struct gve_reply_form form, uint64_t wait_ns,
                     uint64_t now_ns)
{
    wire->listening = (uint8_t)listening;
    wire->form = form;
    wire->found = false;
    wire->over = false;
    wire->until_ns = now_ns + wire->out_length * wire->byte_ns + wait_ns;
    wire->last_ns = wire->until_ns + GAP_MS * GVE_WIRE_NS_PER_MS;
}

/* ---- lines ---- */

static bool is_sent(const struct gve_wire *wire)
{
    const struct text *sent = &wire->sent;
    uint32_t length = wire->length + 1; /* with its CR */
    for (uint32_t at = 0; at + length <= sent->length; at++) {
        if (sent->bytes[at + wire->length] == '\r' && memcmp(sent->bytes + at, wire->line, wire->length) == 0) {
            return true;
        }
    }
    return false;
}

/* What a unit without checksums answers to a command with one. */
static bool is_bare(const struct gve_wire *wire)
{
    return wire->length == 1 && memchr("24AC", wire->line[0], sizeof "24AC" - 1) != NULL;
}

static void take_no_answer(struct gve_wire *wire)
{
    if (is_sent(wire)) {
        wire->heard.echoes++;
        return;
    }
    wire->heard.bare = wire->heard.bare || is_bare(wire);
    wire->heard.damaged++;
    wire->over = true;
}

static void take_answer_line(struct gve_wire *wire)
{
    if (!gve_reply_read(&wire->reply, wire->line, wire->length, wire->sums)) {
        take_no_answer(wire);
    } else if (gve_reply_fits(&wire->reply, wire->form)) {
        wire->found = true;
    } else {
        memcpy(wire->heard.other, wire->reply.values, wire->reply.length + 1U);
    }
}

static void take_bare_index_line(struct gve_wire *wire)
{
    struct gve_reply *reply = &wire->reply;
    const struct gve_reply_form index = {.values = GVE_VALUES_NUMBER};
    bool is_short = wire->length >= BARE_INDEX_BYTES_MIN && wire->length <= BARE_INDEX_BYTES_MAX;
    wire->found = is_short && !gve_reply_read(reply, wire->line, wire->length, true) &&
                  gve_reply_read(reply, wire->line, wire->length, false) && reply->length > 0 &&
                  gve_reply_fits(reply, index);
}

static bool is_halted(struct gve_wire *wire, bool sums)
{
    const struct gve_reply *reply = &wire->reply;
    return gve_reply_read(&wire->reply, wire->line, wire->length, sums) && reply->code == GVE_DONE && reply->inta &&
           reply->length == 0;
}

/* Several H may be under way, with a checksum or without. */
static void take_halted_line(struct gve_wire *wire)
{
    wire->found = is_halted(wire, true) || is_halted(wire, false);
    wire->over = wire->sums && is_bare(wire);
}

static void take_line(struct gve_wire *wire)
{
    switch ((enum gve_listening)wire->listening) {
    case GVE_LISTENS_ANSWER:
        take_answer_line(wire);
        break;
    case GVE_LISTENS_BARE_INDEX:
        take_bare_index_line(wire);
        break;
    case GVE_LISTENS_HALTED:
        take_halted_line(wire);
        break;
    case GVE_LISTENS_NOT:
        break;
    }
}

/* Whether a line is the rest of one that had begun to come too early. */
static bool is_rest(struct gve_wire *wire, uint64_t now_ns)
{
    struct gve_reply reply;
    bool may_be = now_ns < wire->cut_ns;
    wire->cut_ns = 0;
    return may_be && !gve_reply_read(&reply, wire->line, wire->length, true);
}

static void end_line(struct gve_wire *wire, uint64_t now_ns)
{
    bool is_heard = !is_rest(wire, now_ns) && wire->length > 0 && !wire->found && !wire->over;
    if (is_heard) {
        take_line(wire);
    }
    wire->length = 0;
}

void gve_wire_take(struct gve_wire *wire, const uint8_t *bytes, uint32_t length, uint64_t now_ns)
{
    for (uint32_t i = 0; i < length; i++) {
        if (bytes[i] == '\r') {
            end_line(wire, now_ns);
        } else if (bytes[i] != '\n' && wire->length < sizeof wire->line) {
            wire->line[wire->length++] = bytes[i]; /* one byte more than a line has: damage */
        }
    }
    if (wire->length > 0 && wire->listening == GVE_LISTENS_ANSWER) {
        uint64_t gap_ns = now_ns + GAP_MS * GVE_WIRE_NS_PER_MS;
        wire->until_ns = earlier_of(wire->last_ns, later_of(wire->until_ns, gap_ns));
    }
}

bool gve_wire_has_ended(struct gve_wire *wire, uint64_t now_ns)
{
    if (!wire->found && !wire->over && now_ns >= wire->until_ns) {
        wire->over = true;
        wire->heard.damaged += wire->listening == GVE_LISTENS_ANSWER && wire->length > 0 ? 1U : 0U;
    }
    return wire->found || wire->over;
}
