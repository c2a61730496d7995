#include "gve_master_private.h"

enum {
    INDEX_ATTEMPTS = 8,
    AGREE_MIN = 2, /* all but one of them could still be late answers to what was asked before */
};

/* ---- the index ---- */

static void ask_index(struct gve_master *master, uint64_t now_ns)
{
    uint32_t patience_ms = master->asked > 0 ? GVE_PACKET_OVER_MS : GVE_PATIENCE_MS;
    master->asked++;
    gve_master_exchange(master, GVE_STAGE_INDEX, "@", GVE_VALUES_NUMBER, patience_ms, now_ns);
}

void gve_master_find_index(struct gve_master *master, unsigned needed, uint64_t now_ns)
{
    master->needed = (uint8_t)needed;
    master->agree = 0;
    master->asked = 0;
    ask_index(master, now_ns);
}

static void ask_index_again(struct gve_master *master, uint64_t now_ns)
{
    if (master->asked < INDEX_ATTEMPTS) {
        ask_index(master, now_ns);
    } else {
        gve_master_finish_unanswered(master, &master->wire.heard);
    }
}

static void ask_last(struct gve_master *master, enum gve_stage stage, uint64_t now_ns)
{
    const struct gve_reply_form form = master->form;
    gve_master_send(master, stage, ">", master->wire.sums, now_ns);
    gve_wire_listen(&master->wire, GVE_LISTENS_ANSWER, form, GVE_PATIENCE_MS * GVE_WIRE_NS_PER_MS, now_ns);
}

static void take_last(struct gve_master *master)
{
    master->has_last = master->wire.found;
    master->last = master->wire.reply;
}

/* So many commands of the request has the unit counted. */
static uint8_t counted(const struct gve_master *master)
{
    return (uint8_t)(master->index_told - master->index);
}

/* `last` is the answer to the last of a part of a packet: a number stands in that of a packet. */
static void judge_part(struct gve_master *master, uint64_t now_ns)
{
    if (master->last.length > 0) {
        gve_master_try_again(master, now_ns);
    } else {
        gve_master_finish(master, GVE_MASTER_OUT_OF_STEP); /* without *S they were executed one by one */
    }
}

/* Its answer is known. Where the line was dead for long, that is news of then: whoever asked is not to go on by it. */
static void finish_last(struct gve_master *master)
{
    bool is_long = master->order.kind == GVE_MASTER_LONG || master->order.kind == GVE_MASTER_RESET;
    if (master->late && !is_long) {
        gve_master_finish_unanswered(master, &master->wire.heard);
    } else {
        gve_master_finish_answered(master, &master->last);
    }
}

/* It was counted, and `last` is its answer. */
static void judge_last(struct gve_master *master, uint64_t now_ns)
{
    bool is_packet = master->counts > 1;
    bool is_part = counted(master) < master->counts;
    master->index = master->index_told;
    if (is_part) {
        judge_part(master, now_ns);
    } else if (master->last.code != GVE_DAMAGED) {
        finish_last(master);
    } else if (is_packet && master->last.length > 0) {
        gve_master_try_again(master, now_ns); /* it was not taken after all */
    } else {
        gve_master_finish(master, GVE_MASTER_END_UNKNOWN);
    }
}

static void end_repair(struct gve_master *master, uint64_t now_ns)
{
    uint8_t done = counted(master);
    if (master->order.kind == GVE_MASTER_OWN) {
        gve_master_finish(master, done == 0 ? GVE_MASTER_ANSWERED : GVE_MASTER_OUT_OF_STEP);
    } else if (done > master->counts) {
        gve_master_finish(master, GVE_MASTER_OUT_OF_STEP);
    } else if (done == 0) {
        gve_master_try_again(master, now_ns);
    } else if (master->has_last) {
        judge_last(master, now_ns);
    } else {
        master->asked = 1;
        ask_last(master, GVE_STAGE_LAST_AGAIN, now_ns);
    }
}

static void note_index(struct gve_master *master, uint64_t now_ns)
{
    uint8_t told = (uint8_t)gve_reply_number(&master->wire.reply);
    master->agree = master->agree > 0 && told == master->index_told ? (uint8_t)(master->agree + 1) : 1;
    master->index_told = told;
    if (master->agree < master->needed) {
        ask_index_again(master, now_ns);
    } else if (master->ready) {
        end_repair(master, now_ns);
    } else {
        master->index = told;
        gve_master_connected(master, now_ns);
    }
}

void gve_master_after_index(struct gve_master *master, uint64_t now_ns)
{
    const struct gve_wire *wire = &master->wire;
    if (wire->found && wire->reply.code == GVE_DONE) {
        note_index(master, now_ns);
    } else if (wire->heard.bare) {
        gve_master_send(master, GVE_STAGE_INDEX_PROOF, "@", false, now_ns);
        gve_master_listen(master, GVE_LISTENS_BARE_INDEX, GVE_VALUES_NONE, GVE_PATIENCE_MS, now_ns);
    } else {
        ask_index_again(master, now_ns);
    }
}

/* Only a unit without checksums answers what has none. */
void gve_master_after_index_proof(struct gve_master *master, uint64_t now_ns)
{
    if (master->wire.found) {
        gve_master_judge_bare(master, now_ns);
    } else {
        ask_index_again(master, now_ns);
    }
}

/* ---- what has become of a request ---- */

void gve_master_compare_index(struct gve_master *master, uint64_t now_ns)
{
    master->counts = 0;
    master->bare = true; /* it executes nothing */
    gve_master_find_index(master, AGREE_MIN, now_ns);
}

void gve_master_repair(struct gve_master *master, uint64_t now_ns)
{
    master->repairs++;
    ask_last(master, GVE_STAGE_LAST, now_ns);
}

void gve_master_after_last(struct gve_master *master, uint64_t now_ns)
{
    take_last(master);
    gve_master_find_index(master, master->has_last ? AGREE_MIN : AGREE_MIN + 1U, now_ns);
}

void gve_master_after_last_again(struct gve_master *master, uint64_t now_ns)
{
    take_last(master);
    if (master->has_last) {
        judge_last(master, now_ns);
    } else if (master->asked < GVE_ATTEMPTS) {
        master->asked++;
        ask_last(master, GVE_STAGE_LAST_AGAIN, now_ns);
    } else {
        gve_master_finish(master, GVE_MASTER_END_UNKNOWN);
    }
}
