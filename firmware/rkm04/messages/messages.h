/*
 * The messages: a request in, an answer out, no line and no time in between.
 *
 * Comes in: the bytes of one message, as the line or a test delivers them. Goes out: the bytes of the answer. What a
 * message asks for happens through the interpreters and the store that the context names. Main only.
 */
#ifndef MESSAGES_H
#define MESSAGES_H

#include <stdint.h>

#include "base_limits.h"
#include "../program/program_listing.h"
#include "messages_status.h"
#include "../../store/store.h"

enum {
    MESSAGES_REQUEST_BYTES_MAX = 8192,
    /* Get Command: two bytes and a full program memory. */
    MESSAGES_ANSWER_BYTES_MAX = 2 + 700 * PROGRAM_COMMAND_BYTES_MAX,
};

/* The messages, by number. */
#define MESSAGES_MESSAGES(X)                                                                                           \
    X(VERSION, 1)                                                                                                      \
    X(SET_COMMAND, 2)                                                                                                  \
    X(STORE_FLASH, 3)                                                                                                  \
    X(GET_POSITION, 4)                                                                                                 \
    X(GET_COMMAND, 5)                                                                                                  \
    X(GET_TABLE, 6)                                                                                                    \
    X(GET_PROGRESS, 7)                                                                                                 \
    X(GET_STATUS, 200)                                                                                                 \
    X(UNKNOWN, 255)

enum messages_message {
#define X(name, number) MESSAGES_##name = (number),
    MESSAGES_MESSAGES(X)
#undef X
};

struct messages {
    struct interpreter *interpreters; /* UNIT_MOTORS of them */
    const struct interpreter_shared *shared;
    struct store *store;
    const char *version;         /* "NN.NN,DD.MM.YYYY"; at most 255 bytes */
    const uint32_t *line_counts; /* MESSAGES_LINE_COUNTS of them, for Get Status */
};

/* Does what the request asks for and writes the answer. Returns the answer's length; 0 for an empty or over-long
 * request, which has no answer. `now_ticks` is when the request arrived: motors released by it start together.
 * Bytes after what a message needs are ignored. Message 3 for all motors stores every one of them and tells the first
 * error. Message 7 tells 0 steps where no move is in progress. */
uint32_t messages_answer(struct messages *messages, const uint8_t *request, uint32_t length, uint64_t now_ticks,
                         uint8_t answer[MESSAGES_ANSWER_BYTES_MAX]);

#endif
