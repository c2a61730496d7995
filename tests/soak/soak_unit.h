/*
 * The unit of the soak test: on the host machine, under the judge, between canaries, with everything that it does
 * counted and nothing kept, so that a day needs no more memory than a minute.
 */
#ifndef SOAK_UNIT_H
#define SOAK_UNIT_H

#include <stdbool.h>
#include <stdint.h>

#include "host_machine.h"
#include "judge_unit.h"
#include "rkm04.h"

enum {
    SOAK_CANARY_BYTES = 256,
    SOAK_SENT_MAX = 2 * MESSAGES_ANSWER_BYTES_MAX + 64,
};

struct soak_unit {
    struct judged_unit judged;
    uint8_t before[SOAK_CANARY_BYTES];
    struct rkm04 unit;
    uint8_t after[SOAK_CANARY_BYTES];
    struct host_machine machine;
    struct judge judge;
    int64_t position[UNIT_MOTORS]; /* pulses at the pins, signed */
    uint64_t pulses[UNIT_MOTORS];
    uint64_t moves;
    uint64_t errors;
    uint64_t passes;
    uint64_t sent_digest;        /* of all bytes that the unit has sent, and when */
    uint8_t sent[SOAK_SENT_MAX]; /* since the master has read it */
    uint32_t sent_count;
    uint32_t sent_lost; /* there was no room for them */
    uint64_t constants; /* digest of what must never change */
};

/* A unit that has just been switched on, at an epoch of the timer. One at a time. */
void soak_unit_begin(struct soak_unit *soak, uint64_t epoch);

void soak_unit_run(struct soak_unit *soak, uint64_t ticks);

/* Whether the canaries live and what never changes is what it was. */
bool soak_unit_is_whole(const struct soak_unit *soak);

/* All that the unit has done, as a number: the same for every run with the same seed, whatever the epoch. */
uint64_t soak_unit_digest(const struct soak_unit *soak);

#endif
