/*
 * The master of the soak test: requests, repeats, broadcasts, wrong texts, frames for others, damaged frames and noise
 * at the rate of the line, edges at the inputs, and programs again for motors that have ended; all by chance, from one
 * seed. It counts what it sends, so that the unit's own counters can be held against that.
 */
#ifndef SOAK_MASTER_H
#define SOAK_MASTER_H

#include <stdbool.h>
#include <stdint.h>

#include "frames.h"
#include "soak_unit.h"

enum {
    SOAK_TEXT_MAX = 256,
    SOAK_FRAME_MAX = FRAME_BYTES_MAX(SOAK_TEXT_MAX + 2),
};

/* What the master has sent, and what has come back. */
struct soak_tally {
    uint64_t requests; /* to this unit, that want an answer; repeats too */
    uint64_t answers;
    uint64_t repeats;
    uint64_t broadcasts;
    uint64_t foreign;
    uint64_t damaged;  /* frames with one to three wrong bits */
    uint64_t noise;    /* bursts of bytes */
    uint64_t broken;   /* bytes with a framing error */
    uint64_t edges;    /* at inputs */
    uint64_t programs; /* sent, besides the parts of the stream */
    uint64_t full;     /* answers that warned of a full memory */
};

struct soak_master {
    struct soak_unit *soak;
    uint64_t chance;
    struct soak_tally tally;
    const char *trouble; /* the first promise that was broken; null: none */
    uint64_t trouble_tick;
    struct host_line_byte script[SOAK_FRAME_MAX];
    uint8_t frame[SOAK_FRAME_MAX]; /* the last request */
    uint32_t frame_length;
    uint8_t content[SOAK_SENT_MAX]; /* of its answer: address, number, message */
    uint32_t content_length;
    uint8_t before[SOAK_SENT_MAX]; /* the same, before it was repeated */
    uint8_t number;
    uint8_t inputs;
    bool known; /* the unit must know the last request again */
};

/* Sends the programs of the four motors. */
void soak_master_begin(struct soak_master *master, struct soak_unit *soak, uint64_t seed);

/* Does one thing, and lets some time go by. */
void soak_master_act(struct soak_master *master);

/* Resets the motors, waits until they stand, and compares counters and positions. */
void soak_master_end(struct soak_master *master);

#endif
