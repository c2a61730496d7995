#include <string.h>

#include "gve_master_private.h"

enum {
    TRIES = 2, /* one may get lost */
};

/* Before each attempt; one of them is long enough for a packet that was cut off. */
static const uint16_t pauses_ms[] = {0, 200, GVE_PACKET_OVER_MS, 200};

void gve_master_connect(struct gve_master *master, uint64_t now_ns)
{
    master->ready = false;
    master->restarted = false;
    master->others = GVE_MASTER_WAITS;
    master->connecting = 0;
    memset(&master->heard, 0, sizeof master->heard);
    gve_master_pause(master, GVE_STAGE_PAUSE, pauses_ms[0], now_ns);
}

static void note_heard(struct gve_master *master)
{
    const struct gve_heard *heard = &master->wire.heard;
    master->heard.damaged += heard->damaged;
    master->heard.echoes += heard->echoes;
    if (master->heard.other[0] == '\0') {
        memcpy(master->heard.other, heard->other, sizeof heard->other);
    }
}

static void connect_again(struct gve_master *master, uint64_t now_ns)
{
    note_heard(master);
    master->connecting++;
    if (master->connecting < sizeof pauses_ms / sizeof pauses_ms[0]) {
        gve_master_pause(master, GVE_STAGE_PAUSE, pauses_ms[master->connecting], now_ns);
    } else {
        const struct gve_heard heard = master->heard;
        gve_master_finish_unanswered(master, &heard);
    }
}

static void switch_sums(struct gve_master *master, enum gve_stage stage, const char *command, bool sums,
                        uint64_t now_ns)
{
    master->wire.sums = stage != GVE_STAGE_SUMS_OFF;
    gve_master_send(master, stage, command, sums, now_ns);
    gve_master_listen(master, GVE_LISTENS_ANSWER, GVE_VALUES_NONE, GVE_PATIENCE_MS, now_ns);
}

void gve_master_after_pause(struct gve_master *master, uint64_t now_ns)
{
    switch_sums(master, GVE_STAGE_SUMS_ON, "%+", true, now_ns);
}

void gve_master_go_on_bare(struct gve_master *master, uint64_t now_ns)
{
    switch_sums(master, GVE_STAGE_SUMS_ON_BARE, "%+", false, now_ns);
}

static bool is_switched(const struct gve_master *master)
{
    return master->wire.found && master->wire.reply.code == GVE_DONE;
}

static void ask_version(struct gve_master *master, uint64_t now_ns)
{
    master->wire.sums = master->sums;
    gve_master_exchange(master, GVE_STAGE_VERSION, "?", GVE_VALUES_VERSION, GVE_PATIENCE_MS, now_ns);
}

static void begin_version(struct gve_master *master, uint64_t now_ns)
{
    master->asked = 1;
    ask_version(master, now_ns);
}

static void prove_no_sums(struct gve_master *master, uint64_t now_ns)
{
    gve_master_send(master, GVE_STAGE_SUMS_PROOF, "@", false, now_ns);
    gve_master_listen(master, GVE_LISTENS_BARE_INDEX, GVE_VALUES_NONE, GVE_PATIENCE_MS, now_ns);
}

void gve_master_after_sums_on(struct gve_master *master, uint64_t now_ns)
{
    bool is_done = is_switched(master);
    if (master->wanted == GVE_MASTER_SUMS_KEPT) {
        master->sums = is_done; /* what has a checksum changes nothing in a unit without them */
    }
    if (is_done && !master->sums) {
        switch_sums(master, GVE_STAGE_SUMS_OFF, "%-", true, now_ns);
    } else if (is_done || (master->wire.heard.bare && !master->sums)) {
        begin_version(master, now_ns);
    } else if (!master->wire.heard.bare) {
        connect_again(master, now_ns);
    } else if (master->version[0] == '\0') {
        gve_master_go_on_bare(master, now_ns);
    } else {
        master->asked = 1;
        prove_no_sums(master, now_ns);
    }
}

void gve_master_after_sums_proof(struct gve_master *master, uint64_t now_ns)
{
    if (master->wire.found) {
        gve_master_judge_bare(master, now_ns);
    } else if (master->asked < TRIES) {
        master->asked++;
        prove_no_sums(master, now_ns);
    } else {
        connect_again(master, now_ns);
    }
}

void gve_master_after_sums_changed(struct gve_master *master, uint64_t now_ns)
{
    if (is_switched(master)) {
        begin_version(master, now_ns);
    } else {
        connect_again(master, now_ns);
    }
}

void gve_master_after_version(struct gve_master *master, uint64_t now_ns)
{
    const struct gve_reply *reply = &master->wire.reply;
    if (master->wire.found && reply->length > 0) {
        memcpy(master->version, reply->values, reply->length + 1U);
        gve_master_find_index(master, 2, now_ns);
    } else if (!master->wire.found && master->asked < TRIES) {
        master->asked++;
        ask_version(master, now_ns);
    } else {
        master->version[0] = '\0';
        connect_again(master, now_ns);
    }
}
