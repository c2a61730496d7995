/*
 * The unit on its line: from the backend's bytes through the link to the messages, and back. Main only. About 17 kB.
 */
#ifndef RKM04_LINE_H
#define RKM04_LINE_H

#include <stdint.h>

#include "../store/store.h"
#include "link/link.h"
#include "messages/messages.h"

struct rkm04_line {
    struct link link;
    struct messages *messages;                 /* what executes requests */
    uint64_t passed_tick;                      /* the now of main's last pass */
    uint8_t answer[MESSAGES_ANSWER_BYTES_MAX]; /* to the last request */
};

/* Begins to listen, at the address that the switch shows. `now_ticks` is a moment that programs have lived through. */
void rkm04_line_start(struct rkm04_line *line, struct messages *messages, uint64_t now_ticks);

/* Takes what has come in up to the end of one request, executes it, and sends what is to be sent. Returns when to call
 * again at the latest: now if more may have come in, TICK_NEVER if only the backend brings more. */
uint64_t rkm04_line_poll(struct rkm04_line *line);

/* Programs live through `now_ticks`: no request counts as having come before. */
void rkm04_line_note_pass(struct rkm04_line *line, uint64_t now_ticks);

/* LINK_COUNTS_TOTAL counters, since the start. */
const uint32_t *rkm04_line_counts(const struct rkm04_line *line);

/* The answer's STORE_TEXT_BYTES_MAX bytes, for a stored program on its way; only before rkm04_line_start. */
uint8_t *rkm04_line_spare(struct rkm04_line *line);

#endif
