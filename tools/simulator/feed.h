/*
 * The way of a program file into the unit: as Set Command messages, all at the present moment.
 *
 * A program that fits one message is sent as it is. A longer one is sent without blanks and comments, and if that does
 * not fit either, in parts cut between commands by the firmware's parser, with `[` before it and `]` after it, so that
 * nothing runs before all has arrived.
 */
#ifndef FEED_H
#define FEED_H

#include <stdbool.h>

#include "base_limits.h"
#include "infile.h"
#include "rkm04.h"

struct feed {
    struct infile programs[UNIT_MOTORS]; /* path null: none for this motor */
    bool held[UNIT_MOTORS];              /* sent in parts: waits for its `]` */
    uint32_t stored[UNIT_MOTORS];        /* of such a program: its commands after the last `\`, without K and C75 */
    bool overflow[UNIT_MOTORS];          /* program memory was too small: commands were lost (flag 3) */
};

/* Reads the files; null: none. False after a complaint. */
bool feed_read(struct feed *feed, const char *const paths[UNIT_MOTORS]);

/* Sends the programs in the order of the motors. False after a complaint: the unit has refused one. */
bool feed_send(struct feed *feed, struct rkm04 *unit);

/* The ordinal, from 1, in the program file of the command with this ordinal in the unit: where a program has been sent
 * with `[` and `]`, these are not counted. */
uint32_t feed_place(const struct feed *feed, unsigned motor, uint32_t place);

void feed_discard(struct feed *feed);

#endif
