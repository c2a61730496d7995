/*
 * What the parts of the master of a line share: one asks, and when listening has ended goes on to the next stage.
 */
#ifndef GVE_MASTER_PRIVATE_H
#define GVE_MASTER_PRIVATE_H

#include "gve_master.h"

enum {
    GVE_PATIENCE_MS = 500, /* for an answer to begin: 1 ms is the unit's, the rest is for adapters and busy computers */
    GVE_PACKET_OVER_MS = 1200, /* after so much silence no packet is open, and nothing is thrown away any more */
    GVE_ATTEMPTS = 4,
    GVE_LATE_MS = 2000, /* so long a silence a command outlasts */
};

enum gve_stage {
    GVE_STAGE_BEGIN,
    GVE_STAGE_REQUEST,
    GVE_STAGE_LONG,      /* @ after a command that is answered when the axes stand */
    GVE_STAGE_LONG_LATE, /* the answers to these @ */
    GVE_STAGE_LAST,      /* > */
    GVE_STAGE_LAST_AGAIN,
    GVE_STAGE_INDEX,       /* @ */
    GVE_STAGE_INDEX_PROOF, /* @ without a checksum */
    GVE_STAGE_BARE_FLAGS,  /* F and P4 of a unit that has none any more */
    GVE_STAGE_BARE_POSITIONS,
    GVE_STAGE_RESETTING, /* a pause */
    GVE_STAGE_PAUSE,     /* before an attempt to connect */
    GVE_STAGE_SUMS_ON,
    GVE_STAGE_SUMS_PROOF, /* @ without a checksum */
    GVE_STAGE_SUMS_ON_BARE,
    GVE_STAGE_SUMS_OFF,
    GVE_STAGE_VERSION,
    GVE_STAGE_HALT,
    GVE_STAGES
};

/* Sends a command and listens for its answer, each with a checksum or without as the line has them. */
void gve_master_exchange(struct gve_master *master, enum gve_stage stage, const char *command, enum gve_values values,
                         uint32_t patience_ms, uint64_t now_ns);

/* The same with a checksum or without, whatever the line has. */
void gve_master_send(struct gve_master *master, enum gve_stage stage, const char *command, bool sums, uint64_t now_ns);
void gve_master_listen(struct gve_master *master, enum gve_listening listening, enum gve_values values,
                       uint32_t patience_ms, uint64_t now_ns);

/* Lets time pass. */
void gve_master_pause(struct gve_master *master, enum gve_stage stage, uint32_t pause_ms, uint64_t now_ns);

/* The request has ended; without an answer, by what was heard. */
void gve_master_finish(struct gve_master *master, enum gve_master_end end);
void gve_master_finish_answered(struct gve_master *master, const struct gve_reply *reply);
void gve_master_finish_unanswered(struct gve_master *master, const struct gve_heard *heard);

/* Connects; then goes on with gve_master_connected. */
void gve_master_connect(struct gve_master *master, uint64_t now_ns);
void gve_master_connected(struct gve_master *master, uint64_t now_ns);

/* Goes on to connect to a unit that has no checksums. */
void gve_master_go_on_bare(struct gve_master *master, uint64_t now_ns);

/* Finds out why a unit that is known has no checksums, as the answer to @ proves; then ends the request, or goes on to
 * connect. */
void gve_master_judge_bare(struct gve_master *master, uint64_t now_ns);

/* The request was not executed: it is sent again, or given up. */
void gve_master_try_again(struct gve_master *master, uint64_t now_ns);

/* Finds out whether the index is that of what was sent from here. */
void gve_master_compare_index(struct gve_master *master, uint64_t now_ns);

/* Finds out what has become of the request. */
void gve_master_repair(struct gve_master *master, uint64_t now_ns);

/* Finds the index, on which so many answers in succession have to agree; then goes on with what it was wanted for. */
void gve_master_find_index(struct gve_master *master, unsigned needed, uint64_t now_ns);

/* Whether all positions are told to be 0. */
bool gve_master_is_zero(const struct gve_reply *reply);

/* Waits for what ends when the axes stand. */
void gve_master_wait_long(struct gve_master *master, uint64_t now_ns);

void gve_master_halt(struct gve_master *master, uint64_t now_ns);

/* What follows when listening has ended. */
void gve_master_after_pause(struct gve_master *master, uint64_t now_ns);
void gve_master_after_sums_on(struct gve_master *master, uint64_t now_ns);
void gve_master_after_sums_proof(struct gve_master *master, uint64_t now_ns);
void gve_master_after_sums_changed(struct gve_master *master, uint64_t now_ns);
void gve_master_after_version(struct gve_master *master, uint64_t now_ns);
void gve_master_after_index(struct gve_master *master, uint64_t now_ns);
void gve_master_after_index_proof(struct gve_master *master, uint64_t now_ns);
void gve_master_after_bare_flags(struct gve_master *master, uint64_t now_ns);
void gve_master_after_bare_positions(struct gve_master *master, uint64_t now_ns);
void gve_master_after_last(struct gve_master *master, uint64_t now_ns);
void gve_master_after_last_again(struct gve_master *master, uint64_t now_ns);
void gve_master_after_long(struct gve_master *master, uint64_t now_ns);
void gve_master_after_long_late(struct gve_master *master, uint64_t now_ns);
void gve_master_after_halt(struct gve_master *master, uint64_t now_ns);

#endif
