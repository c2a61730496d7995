/*
 * The messages: a request in, an answer out, no line and no time in between.
 *
 * Comes in: the bytes of one message, as the line or a test delivers them. Goes out: the bytes of the answer. What a
 * message asks for happens through the interpreters, the movers and the store that the context names. Main only.
 */
#ifndef PROTOCOL_H
#define PROTOCOL_H

#include <stdint.h>

#include "base_limits.h"
#include "interpreter.h"
#include "mover.h"
#include "program_listing.h"
#include "protocol_status.h"
#include "store.h"

enum {
    PROTOCOL_REQUEST_BYTES_MAX = 8192,
    /* Get Command: two bytes and a full program memory. */
    PROTOCOL_ANSWER_BYTES_MAX = 2 + 700 * PROGRAM_COMMAND_BYTES_MAX,
};

/* The messages, by number. */
#define PROTOCOL_MESSAGES(X)                                                                                           \
    X(VERSION, 1)                                                                                                      \
    X(SET_COMMAND, 2)                                                                                                  \
    X(STORE_FLASH, 3)                                                                                                  \
    X(GET_POSITION, 4)                                                                                                 \
    X(GET_COMMAND, 5)                                                                                                  \
    X(GET_TABLE, 6)                                                                                                    \
    X(GET_PROGRESS, 7)                                                                                                 \
    X(GET_STATUS, 200)                                                                                                 \
    X(UNKNOWN, 255)

enum protocol_message {
#define X(name, number) PROTOCOL_##name = (number),
    PROTOCOL_MESSAGES(X)
#undef X
};

struct protocol {
    struct interpreter *interpreters; /* UNIT_MOTORS of them */
    struct store *store;
    const char *version;         /* "NN.NN,DD.MM.YYYY"; at most 255 bytes */
    const uint32_t *line_counts; /* PROTOCOL_LINE_COUNTS of them, for Get Status */
};

/* Does what the request asks for and writes the answer. Returns the answer's length; 0 for an empty or over-long
 * request, which has no answer. `now_ticks` is when the request arrived: motors released by it start together.
 * Bytes behind what a message needs are ignored. Message 3 for all motors stores every one of them and tells the first
 * error. Message 7 tells 0 steps where no move is in progress. */
uint32_t protocol_answer(struct protocol *protocol, const uint8_t *request, uint32_t length, uint64_t now_ticks,
                         uint8_t answer[PROTOCOL_ANSWER_BYTES_MAX]);

#endif
