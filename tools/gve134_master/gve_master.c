#include "gve_master.h"

#include <assert.h>
#include <string.h>

#include "gve_master_private.h"

enum {
    MEMORY_MS = 2500,
    RESET_MS = 500,
    PACKET_BYTES_MAX = 12, /* of *E and a number, with a zero */
    PACKET_ENDS = 2,       /* commands around those of a packet */
};

void gve_master_init(struct gve_master *master, uint32_t baud, enum gve_master_sums sums)
{
    memset(master, 0, sizeof *master);
    gve_wire_init(&master->wire, baud);
    master->wanted = (uint8_t)sums;
    master->sums = sums == GVE_MASTER_SUMS_ON;
    master->end = GVE_MASTER_ANSWERED;
}

/* ---- what all stages need ---- */

void gve_master_send(struct gve_master *master, enum gve_stage stage, const char *command, bool sums, uint64_t now_ns)
{
    master->stage = (uint8_t)stage;
    gve_wire_begin(&master->wire, now_ns);
    gve_wire_put(&master->wire, (const uint8_t *)command, (uint32_t)strlen(command), sums);
}

void gve_master_listen(struct gve_master *master, enum gve_listening listening, enum gve_values values,
                       uint32_t patience_ms, uint64_t now_ns)
{
    const struct gve_reply_form form = {.values = (uint8_t)values};
    gve_wire_listen(&master->wire, listening, form, patience_ms * GVE_WIRE_NS_PER_MS, now_ns);
}

void gve_master_exchange(struct gve_master *master, enum gve_stage stage, const char *command, enum gve_values values,
                         uint32_t patience_ms, uint64_t now_ns)
{
    gve_master_send(master, stage, command, master->wire.sums, now_ns);
    gve_master_listen(master, GVE_LISTENS_ANSWER, values, patience_ms, now_ns);
}

void gve_master_pause(struct gve_master *master, enum gve_stage stage, uint32_t pause_ms, uint64_t now_ns)
{
    master->stage = (uint8_t)stage;
    gve_master_listen(master, GVE_LISTENS_NOT, GVE_VALUES_NONE, pause_ms, now_ns);
}

void gve_master_finish(struct gve_master *master, enum gve_master_end end)
{
    master->end = (uint8_t)end;
    master->ready = master->ready && (end == GVE_MASTER_ANSWERED || end == GVE_MASTER_NOT_TAKEN);
}

bool gve_master_is_zero(const struct gve_reply *reply)
{
    return strcmp(reply->values, "0,0,0,0") == 0;
}

static void note_place(struct gve_master *master)
{
    unsigned opcode = gve_reply_opcode(master->text, master->order.length);
    bool is_told = opcode == (unsigned)GVE_POSITION_4 && master->reply.code == GVE_DONE;
    if (is_told) {
        master->is_elsewhere = !gve_master_is_zero(&master->reply);
    } else if (opcode == (unsigned)GVE_ZERO || opcode == (unsigned)GVE_SET_POSITION) {
        master->is_elsewhere = false;
    } else {
        /* it tells nothing of that */
    }
}

void gve_master_finish_answered(struct gve_master *master, const struct gve_reply *reply)
{
    master->reply = *reply;
    note_place(master);
    gve_master_finish(master, GVE_MASTER_ANSWERED);
}

void gve_master_finish_unanswered(struct gve_master *master, const struct gve_heard *heard)
{
    enum gve_master_end end = GVE_MASTER_SILENT;
    if (heard->other[0] != '\0' && master->version[0] == '\0') {
        end = GVE_MASTER_OTHER_DEVICE;
    } else if (heard->damaged > 0) {
        end = GVE_MASTER_GARBLED;
    } else if (heard->echoes > 0) {
        end = GVE_MASTER_ECHOED;
    } else {
        /* nothing has come */
    }
    master->heard = *heard;
    gve_master_finish(master, end);
}

/* ---- the request ---- */

static bool is_packet(const struct gve_master *master)
{
    return master->order.kind == GVE_MASTER_PACKET || master->order.kind == GVE_MASTER_PACKET_ONCE;
}

/* Puts the commands that stand in the text; returns how many they are. */
static uint32_t put_commands(struct gve_master *master)
{
    uint32_t count = 0;
    uint32_t begin = 0;
    for (uint32_t at = 0; at <= master->order.length && master->order.length > 0; at++) {
        if (at == master->order.length || master->text[at] == '\n') {
            gve_wire_put(&master->wire, master->text + begin, at - begin, master->wire.sums);
            begin = at + 1;
            count++;
        }
    }
    return count;
}

static uint32_t put_packet(struct gve_master *master)
{
    uint8_t end[PACKET_BYTES_MAX];
    struct text text;
    gve_wire_put(&master->wire, (const uint8_t *)"*S", 2, master->wire.sums);
    uint32_t count = put_commands(master);
    text_init(&text, end, sizeof end);
    text_put_string(&text, "*E");
    text_put_unsigned(&text, count, 0);
    gve_wire_put(&master->wire, text.bytes, text.length, master->wire.sums);
    return count;
}

static void send_request(struct gve_master *master, uint64_t now_ns)
{
    uint64_t patience_ms = GVE_PATIENCE_MS;
    gve_wire_begin(&master->wire, now_ns);
    if (is_packet(master)) {
        uint32_t count = put_packet(master);
        master->counts = count + PACKET_ENDS;
        master->form = (struct gve_reply_form){.values = GVE_VALUES_COUNT, .count = count};
        patience_ms = GVE_PACKET_OVER_MS;
    } else {
        unsigned opcode = gve_reply_opcode(master->text, master->order.length);
        (void)put_commands(master);
        master->counts = opcode == (unsigned)GVE_INDEX || opcode == (unsigned)GVE_REPEAT ? 0 : 1;
        master->form = (struct gve_reply_form){.values = (uint8_t)gve_reply_values(opcode)};
        bool is_write = opcode >= (unsigned)GVE_WRITE_BYTE && opcode <= (unsigned)GVE_WRITE_SINGLE;
        patience_ms = is_write ? (uint64_t)MEMORY_MS : patience_ms;
    }
    master->stage = GVE_STAGE_REQUEST;
    gve_wire_listen(&master->wire, GVE_LISTENS_ANSWER, master->form, patience_ms * GVE_WIRE_NS_PER_MS, now_ns);
}

static void after_request(struct gve_master *master, uint64_t now_ns)
{
    const struct gve_wire *wire = &master->wire;
    bool is_long = master->order.kind == GVE_MASTER_LONG;
    bool is_single = is_packet(master) && wire->reply.length == 0; /* *E was, and all before it: *S was lost */
    if (wire->found && wire->reply.code != GVE_DAMAGED && !is_single) {
        master->index = (uint8_t)(master->index + master->counts);
        gve_master_finish_answered(master, &wire->reply);
    } else if (is_long && !wire->found) {
        gve_master_wait_long(master, now_ns);
    } else {
        master->bare = wire->heard.bare && !is_long;
        gve_master_repair(master, now_ns);
    }
}

void gve_master_try_again(struct gve_master *master, uint64_t now_ns)
{
    master->attempt++;
    if (master->late) {
        gve_master_finish_unanswered(master, &master->wire.heard);
    } else if (master->order.kind == GVE_MASTER_PACKET_ONCE) {
        gve_master_finish(master, GVE_MASTER_NOT_TAKEN);
    } else if (master->attempt < GVE_ATTEMPTS) {
        send_request(master, now_ns);
    } else {
        gve_master_finish_unanswered(master, &master->wire.heard);
    }
}

void gve_master_connected(struct gve_master *master, uint64_t now_ns)
{
    bool is_only = master->order.kind == GVE_MASTER_CONNECT || master->order.kind == GVE_MASTER_HALT;
    master->ready = true;
    master->is_index_known = true;
    if (is_only || master->is_reset) {
        master->restarted = master->restarted && is_only;
        master->others = is_only ? master->others : (uint8_t)GVE_MASTER_WAITS;
        master->end = GVE_MASTER_ANSWERED;
    } else if (master->restarted) {
        master->end = GVE_MASTER_RESTARTED; /* it was not meant for this unit, which is known now */
    } else if (master->others != (uint8_t)GVE_MASTER_WAITS) {
        master->end = master->others;
    } else if (master->order.kind == GVE_MASTER_OWN) {
        master->end = GVE_MASTER_ANSWERED;
    } else {
        master->late = false; /* that it takes so long to connect is usual after a packet that was cut off */
        send_request(master, now_ns);
    }
}

void gve_master_begin(struct gve_master *master, const struct gve_master_order *order, uint64_t now_ns)
{
    assert(order->length <= (uint32_t)GVE_WIRE_TEXT_BYTES);
    master->order = *order;
    master->end = GVE_MASTER_WAITS;
    master->attempt = 0;
    master->heard_ns = now_ns;
    master->late = false;
    master->long_halt = false;
    master->is_reset = false;
    memset(&master->reply, 0, sizeof master->reply);
    gve_master_pause(master, GVE_STAGE_BEGIN, 0, now_ns);
}

static void after_begin(struct gve_master *master, uint64_t now_ns)
{
    if (master->order.kind == GVE_MASTER_HALT) {
        gve_master_halt(master, now_ns);
    } else if (master->order.kind == GVE_MASTER_CONNECT || !master->ready) {
        gve_master_connect(master, now_ns);
    } else if (master->order.kind == GVE_MASTER_OWN) {
        gve_master_compare_index(master, now_ns);
    } else {
        send_request(master, now_ns);
    }
}

void gve_master_take(struct gve_master *master, const uint8_t *bytes, uint32_t length, uint64_t now_ns)
{
    gve_wire_take(&master->wire, bytes, length, now_ns);
}

static void go_on(struct gve_master *master, uint64_t now_ns)
{
    static void (*const after[GVE_STAGES])(struct gve_master *, uint64_t) = {
        [GVE_STAGE_BEGIN] = after_begin,
        [GVE_STAGE_REQUEST] = after_request,
        [GVE_STAGE_LONG] = gve_master_after_long,
        [GVE_STAGE_LONG_LATE] = gve_master_after_long_late,
        [GVE_STAGE_LAST] = gve_master_after_last,
        [GVE_STAGE_LAST_AGAIN] = gve_master_after_last_again,
        [GVE_STAGE_INDEX] = gve_master_after_index,
        [GVE_STAGE_INDEX_PROOF] = gve_master_after_index_proof,
        [GVE_STAGE_BARE_FLAGS] = gve_master_after_bare_flags,
        [GVE_STAGE_BARE_POSITIONS] = gve_master_after_bare_positions,
        [GVE_STAGE_RESETTING] = gve_master_connect,
        [GVE_STAGE_PAUSE] = gve_master_after_pause,
        [GVE_STAGE_SUMS_ON] = gve_master_after_sums_on,
        [GVE_STAGE_SUMS_PROOF] = gve_master_after_sums_proof,
        [GVE_STAGE_SUMS_ON_BARE] = gve_master_after_sums_changed,
        [GVE_STAGE_SUMS_OFF] = gve_master_after_sums_changed,
        [GVE_STAGE_VERSION] = gve_master_after_version,
        [GVE_STAGE_HALT] = gve_master_after_halt,
    };
    after[master->stage](master, now_ns);
}

/* J may have taken its answer along: the unit that has restarted is the one that was asked for. */
static void go_on_after_reset(struct gve_master *master, uint64_t now_ns)
{
    bool is_gone = master->end == GVE_MASTER_RESTARTED || master->end == GVE_MASTER_RESTARTED_PERHAPS;
    if (master->order.kind == GVE_MASTER_RESET && !master->is_reset &&
        (is_gone || master->end == GVE_MASTER_ANSWERED)) {
        master->is_reset = true;
        master->end = GVE_MASTER_WAITS;
        gve_master_pause(master, GVE_STAGE_RESETTING, RESET_MS, now_ns);
    }
}

static void note_silence(struct gve_master *master, uint64_t now_ns)
{
    if (master->wire.found) {
        master->late = master->late || now_ns - master->heard_ns > GVE_LATE_MS * GVE_WIRE_NS_PER_MS;
        master->heard_ns = now_ns;
    }
}

enum gve_master_end gve_master_poll(struct gve_master *master, uint64_t now_ns)
{
    while (master->end == GVE_MASTER_WAITS && gve_wire_has_ended(&master->wire, now_ns)) {
        note_silence(master, now_ns);
        go_on(master, now_ns);
        go_on_after_reset(master, now_ns);
    }
    return (enum gve_master_end)master->end;
}

void gve_master_forget(struct gve_master *master)
{
    master->ready = false;
    if (master->end == GVE_MASTER_WAITS) {
        master->end = GVE_MASTER_SILENT;
    }
}
