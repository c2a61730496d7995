/*
 * The link of one unit: bytes of the line in, requests out to be executed; answers in, bytes for the line out.
 *
 * It holds the session (line.md, "Sessions"): until a Version with a number has come no request with a number is
 * executed, it is refused; and one with the number and the message of the one answered last is not executed but
 * answered again. Of that request the link keeps the length and a CRC-32; the answer stays in a buffer of the owner's.
 * It listens or sends, never both. Main only. About 8.4 kB.
 */
#ifndef LINK_H
#define LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_line.h"
#include "link_frame.h"
#include "link_receiver.h"
#include "link_sender.h"

struct link_request {
    const uint8_t *message; /* holds until the next call of link_take */
    uint32_t length;        /* 1 to LINK_REQUEST_BYTES_MAX */
    uint64_t end_tick;      /* the end of its last byte */
    bool broadcast;         /* to be executed and not to be answered */
};

struct link {
    struct link_receiver receiver;
    struct link_sender sender;
    const uint8_t *answer; /* to the request below */
    uint32_t answer_length;
    uint32_t answered_length; /* bytes of the request answered last */
    uint32_t answered_crc;    /* its CRC-32 */
    uint64_t ready_tick;      /* when link_poll first saw an answer to be sent; TICK_NEVER: not yet */
    uint8_t answered_number;  /* its number; 0: no request is known again */
    uint8_t answer_number;    /* the number that the answer carries */
    bool waiting;             /* the answer is to be sent */
    bool open;                /* a session has been opened since the start */
    uint8_t message[LINK_BUFFER_BYTES];
};

/* No session is open; silence. `node` is 1 to 16; `answer` is where link_answer finds the answers. */
void link_init(struct link *link, uint8_t node, const uint8_t *answer);

/* Takes one byte; not while sending. True: *request is to be executed and, if it is not a broadcast, link_answer to
 * be called, before the next byte. An answer that has not been begun is given up when a request comes. */
bool link_take(struct link *link, const struct hal_line_byte *byte, struct link_request *request);

/* The request has been executed; its answer, 1 to LINK_ANSWER_BYTES_MAX bytes, stands in the buffer and stays there
 * until the next one. */
void link_answer(struct link *link, uint32_t length);

/* Bytes of the answer that must be kept for a repeat; 0: none. */
uint32_t link_kept_bytes(const struct link *link);

/* The answer could not be kept: a repeat will be executed. */
void link_forget(struct link *link);

/* Begins an answer that is due. Returns when to call again at the latest; TICK_NEVER: nothing is to be sent, or it has
 * been begun. All bytes that have come in must have been taken. */
uint64_t link_poll(struct link *link, uint64_t now_ticks);

/* Whether there is a byte to be sent; that byte; and past it. */
bool link_is_sending(const struct link *link);
uint8_t link_byte(const struct link *link);
void link_advance(struct link *link);

#endif
