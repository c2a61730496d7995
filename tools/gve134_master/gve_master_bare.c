/*
 * A unit that is known and has no checksums any more. Either it has restarted: its index and its positions count from
 * 0, and nothing moves or waits; or another program has switched them off: its index has gone on, and all else, too.
 *
 * A restart is told only where nothing speaks against it: who is told of one takes axes and spindle to stand.
 */
#include "gve_master_private.h"

enum {
    TRIES = 2,     /* one may get lost */
    FRESH_MAX = 8, /* so many commands a unit that has restarted has counted at the most when it is found out */
    PAST_MAX = 32, /* so many another program counts before it is found out, as a rule */
    RUN = 0x40,    /* of F: axes move, or vectors wait */
};

static void ask_flags(struct gve_master *master, uint64_t now_ns)
{
    master->asked++;
    master->wire.sums = false;
    gve_master_exchange(master, GVE_STAGE_BARE_FLAGS, "F", GVE_VALUES_BYTE, GVE_PATIENCE_MS, now_ns);
}

static void ask_positions(struct gve_master *master, uint64_t now_ns)
{
    master->asked++;
    gve_master_exchange(master, GVE_STAGE_BARE_POSITIONS, "P4", GVE_VALUES_DECIMALS_4, GVE_PATIENCE_MS, now_ns);
}

void gve_master_judge_bare(struct gve_master *master, uint64_t now_ns)
{
    master->bare_stage = master->stage;
    master->index_told = (uint8_t)gve_reply_number(&master->wire.reply);
    master->asked = 0;
    ask_flags(master, now_ns);
}

static void conclude(struct gve_master *master, enum gve_master_end end, uint64_t now_ns)
{
    bool may_be_executed = master->ready && !master->bare;
    master->is_elsewhere = false;
    if (master->bare_stage == GVE_STAGE_SUMS_PROOF) {
        master->restarted = end == GVE_MASTER_RESTARTED;
        master->others = (uint8_t)(master->restarted ? GVE_MASTER_WAITS : end);
        gve_master_go_on_bare(master, now_ns);
        return;
    }
    master->version[0] = '\0'; /* so that connecting to it is no news any more */
    gve_master_finish(master, end == GVE_MASTER_RESTARTED && may_be_executed ? GVE_MASTER_RESTARTED_PERHAPS : end);
}

static void ask_again(struct gve_master *master, void (*ask)(struct gve_master *, uint64_t), uint64_t now_ns)
{
    if (master->asked < TRIES) {
        ask(master, now_ns);
    } else {
        conclude(master, GVE_MASTER_OUT_OF_STEP, now_ns);
    }
}

/* Whether the index is where it was, or just past that: then it has not gone back. */
static bool is_past(const struct gve_master *master, uint32_t own)
{
    bool is_taken = master->ready && !master->bare; /* or may be */
    bool is_reset = is_taken && master->order.kind == GVE_MASTER_RESET;
    uint8_t passed = (uint8_t)(master->index_told - master->index);
    return !is_reset && (!master->is_index_known || passed <= PAST_MAX + own);
}

static enum gve_master_end judged(const struct gve_master *master, bool is_at_zero)
{
    uint32_t own = master->ready ? master->counts : 0; /* of the request, one by one as it was refused */
    bool is_fresh = is_at_zero && master->index_told <= FRESH_MAX + own;
    bool has_past = is_past(master, own);
    if (is_fresh && (!has_past || master->is_elsewhere)) {
        return GVE_MASTER_RESTARTED;
    }
    return has_past && !is_fresh ? GVE_MASTER_SUMS_OFF : GVE_MASTER_OUT_OF_STEP;
}

void gve_master_after_bare_flags(struct gve_master *master, uint64_t now_ns)
{
    const struct gve_reply *reply = &master->wire.reply;
    if (!master->wire.found || reply->code != GVE_DONE) {
        ask_again(master, ask_flags, now_ns);
    } else if ((gve_reply_byte(reply) & (unsigned)RUN) != 0) {
        conclude(master, GVE_MASTER_SUMS_OFF, now_ns);
    } else {
        master->asked = 0;
        ask_positions(master, now_ns);
    }
}

void gve_master_after_bare_positions(struct gve_master *master, uint64_t now_ns)
{
    const struct gve_reply *reply = &master->wire.reply;
    if (!master->wire.found || reply->code != GVE_DONE) {
        ask_again(master, ask_positions, now_ns);
    } else {
        conclude(master, judged(master, gve_master_is_zero(reply)), now_ns);
    }
}
