/*
 * The master of a line: one request at a time in, its answer out, with the sessions, numbers and repeats of line.md.
 *
 * It does not wait: its owner writes what stands in `out`, hands in what has come, and looks again in time. What is
 * sent is made by the sender of the units, what is heard is judged by their receiver. Time is the owner's, in ns from
 * any moment, and does not go back. 42 kB.
 */
#ifndef MASTER_H
#define MASTER_H

#include <stdbool.h>
#include <stdint.h>

#include "link_frame.h"
#include "master_ear.h"

enum {
    MASTER_OUT_BYTES = 2 * (LINK_HEAD_BYTES + LINK_REQUEST_BYTES_MAX + LINK_FCS_BYTES) + 2
};

/* How a request has ended. */
enum master_end {
    MASTER_WAITS,          /* not yet */
    MASTER_ANSWERED,       /* a broadcast: it has gone out */
    MASTER_SILENT,         /* nothing came back */
    MASTER_ECHOED,         /* nothing but what was sent */
    MASTER_DAMAGED,        /* something, and no frame of it was whole */
    MASTER_RESTARTED,      /* the unit has started anew, and has not executed it */
    MASTER_RESTARTED_SENT, /* the same, but it may have executed it before that */
    MASTER_GIVEN_UP,       /* master_hurry, before it was sent */
};

struct master_order {
    uint8_t node;         /* 1 to 16; 0: all units, and none answers */
    bool in_session;      /* false: it may be executed twice, and needs no session */
    uint32_t length;      /* of the message, 1 to LINK_REQUEST_BYTES_MAX */
    uint32_t patience_ms; /* for an answer to begin */
    uint32_t attempts;    /* 1 and more */
};

struct master {
    struct master_order order;
    struct master_ear ear;
    uint64_t byte_ns;
    uint64_t sent_ns;  /* when the frame has gone out */
    uint64_t until_ns; /* so long an answer is waited for */
    uint64_t last_ns;  /* so long at the most, whatever comes */
    uint32_t usual_ms; /* see master_init */
    uint32_t attempt;  /* of the frame under way, from 1 */
    uint32_t out_length;
    uint32_t chance;
    uint32_t sessions[LINK_NODE_MAX + 1]; /* so many were begun with each node */
    uint8_t numbers[LINK_NODE_MAX + 1];   /* the last of each session; LINK_NUMBER_NONE: there is no session */
    uint8_t number;                       /* of the frame under way */
    uint8_t stage;
    uint8_t end;  /* enum master_end */
    bool again;   /* the unit has restarted once since the request was given */
    bool hurried; /* something else waits */
    bool scans;   /* a second answer is waited for */
    bool twice;   /* it has come */
    bool echoed;  /* the frame under way has come back */
    bool echoes;  /* some frame has: the adapter of this line hears what it sends */
    bool damaged;
    uint32_t answer_length;                  /* after MASTER_ANSWERED; 0: it was a broadcast */
    uint8_t answer[LINK_ANSWER_BYTES_MAX];   /* until the next request */
    uint8_t message[LINK_REQUEST_BYTES_MAX]; /* the request, put there by the owner */
    uint8_t out[MASTER_OUT_BYTES];           /* out_length bytes to be written now */
};

/* A line without sessions. `chance` is not 0, and another one each time. `usual_ms` is the patience for what takes a
 * unit no time, so a session is opened with no more, and who is in a hurry has no more: 20 ms are the unit's, the rest
 * is for adapters and busy computers. */
void master_init(struct master *master, uint32_t chance, uint32_t baud, uint32_t usual_ms);

/* Begins the request whose message stands in `message`; what was under way before is given up. */
void master_ask(struct master *master, const struct master_order *order, uint64_t now_ns);

/* Begins to ask whether there is a unit with this address, or more than one: for its version, in a session of its own.
 * After the answer a second one is waited for as long as for the first; `twice` says then whether one has come. */
void master_scan(struct master *master, uint8_t node, uint32_t patience_ms, uint32_t attempts, uint64_t now_ns);

/* Takes what has come. What comes while nothing is under way is dropped, as an answer that was too late. */
void master_take(struct master *master, const uint8_t *bytes, uint32_t length, uint64_t now_ns);

/* Repeats what has not been answered in time, or ends it. To be called at `until_ns` at the latest. */
enum master_end master_poll(struct master *master, uint64_t now_ns);

/* Something else waits: no more repeats, and an answer has to begin in the usual time. */
void master_hurry(struct master *master, uint64_t now_ns);

/* The next request to this node begins a session of its own. */
void master_forget(struct master *master, uint8_t node);

#endif
