/*
 * The master of a line of positioning units: one request at a time in, its answer out; Modbus RTU as in line.md, or
 * Modbus TCP to a gateway.
 *
 * It does not wait: its owner reads what has come and hands it in, then looks what has become of the request, and
 * writes what stands in `sent`. Time is the owner's, in ns from any moment, and does not go back. Repeating is safe: a
 * unit executes no instruction word twice, and all else that is written is the same again. 1.1 kB.
 */
#ifndef POS_MASTER_H
#define POS_MASTER_H

#include <stdbool.h>
#include <stdint.h>

#include "pos_master_ear.h"
#include "pos_master_frame.h"

enum {
    POS_MASTER_CHARACTER_BITS = 11, /* the longest character of the formats */
    POS_MASTER_REST_MS = 150,       /* of silence: an answer that has begun has ended, whole or not */
    POS_MASTER_OTHERS_MS_MAX = 500, /* however much others say, or a line hums: more is not listened to */
    POS_MASTER_TURN_MS = 100,       /* units have for a broadcast, which none answers */
    POS_MASTER_AWAY = 0x0B,         /* the exception by which a gateway tells that a unit does not answer */
};

/* How a request has ended. */
enum pos_master_end {
    POS_MASTER_WAITS,    /* not yet */
    POS_MASTER_ANSWERED, /* a broadcast: it has gone out */
    POS_MASTER_REFUSED,  /* by an exception, and has changed nothing */
    POS_MASTER_SILENT,   /* nothing came back */
    POS_MASTER_ECHOED,   /* nothing but what was sent */
    POS_MASTER_DAMAGED,  /* something, and not all of it was whole frames */
    POS_MASTER_ABSENT,   /* a gateway tells that the unit does not answer: POS_MASTER_AWAY */
};

struct pos_master_order {
    uint8_t node;         /* 1 and more; 0: all units, and none answers */
    uint32_t length;      /* of the request, 1 to POS_MASTER_REQUEST_BYTES_MAX */
    uint32_t patience_ms; /* for an answer to begin; one that writes STORE has POS_MASTER_STORE_MS more */
    uint32_t attempts;    /* 1 and more */
};

struct pos_master {
    struct pos_master_order order;
    struct pos_master_ear ear;
    uint64_t byte_ns;
    uint64_t gap_ns;
    uint64_t quiet_ns; /* since then nothing has come */
    uint64_t until_ns; /* to be polled then at the latest */
    uint64_t last_ns;  /* the same, whatever comes */
    uint32_t attempt;  /* from 1; 0: nothing has been sent yet */
    uint32_t out_length;
    uint16_t number;                               /* of the last frame of Modbus TCP */
    uint8_t end;                                   /* enum pos_master_end */
    bool listening;                                /* false: the request waits for the line to be silent */
    bool owed;                                     /* an answer that is too late may come yet */
    uint8_t request[POS_MASTER_REQUEST_BYTES_MAX]; /* from the function on, put there by the owner */
    struct pos_master_frame sent; /* its first out_length bytes are to be written now; the owner then sets that to 0 */
};

/* `baud` is that of the line; 0: bytes take no time, as to a unit that is simulated here. A gateway is asked over
 * Modbus TCP, and minds the silences of its line itself. */
void pos_master_init(struct pos_master *master, uint32_t baud, bool tcp);

/* Begins the request that stands in `request`. One that is under way is given up: what it has in `sent` does not go
 * out, and what is answered to it is dropped. */
void pos_master_ask(struct pos_master *master, const struct pos_master_order *order, uint64_t now_ns);

/* Takes what has come. What comes before the request has been sent, or after its answer, is dropped. */
void pos_master_take(struct pos_master *master, const uint8_t *bytes, uint32_t length, uint64_t now_ns);

/* Sends what is due, repeats what has not been answered in time, or ends it. To be called at `until_ns` at the latest,
 * when all that has come before has been taken. */
enum pos_master_end pos_master_poll(struct pos_master *master, uint64_t now_ns);

/* After POS_MASTER_ANSWERED, POS_MASTER_REFUSED and POS_MASTER_ABSENT, until the next request: the answer from its
 * function on, which is whole and has the function that was asked for; none to a broadcast. */
const uint8_t *pos_master_answer(const struct pos_master *master);
uint32_t pos_master_answer_length(const struct pos_master *master);

#endif
