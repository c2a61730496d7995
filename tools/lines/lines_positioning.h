/*
 * The master of a line of positioning units (tools/positioning_master) for those that can hand over numbers only: the
 * worker of a page, by the module positioning-unit of WebAssembly, and tools in Python, by the shared library
 * rkm04-lines.
 */
#ifndef LINES_POSITIONING_H
#define LINES_POSITIONING_H

#include <stdbool.h>
#include <stdint.h>

#include "lines_shared.h"

enum {
    LINES_POSITIONING_HEARD_BYTES = 4096
};

struct lines_positioning;

/* See pos_master_init. Null: there is not memory enough. */
LINES_SHARED struct lines_positioning *lines_positioning_begin(uint32_t baud, bool tcp);

/* Null is fine. */
LINES_SHARED void lines_positioning_end(struct lines_positioning *line);

/* Where a request is to be put, from its function on: POS_MASTER_REQUEST_BYTES_MAX; and what has come:
 * LINES_POSITIONING_HEARD_BYTES. */
LINES_SHARED uint8_t *lines_positioning_request(struct lines_positioning *line);
LINES_SHARED uint8_t *lines_positioning_heard(struct lines_positioning *line);

/* See pos_master_ask, pos_master_take and pos_master_poll; when the next call of that is due at the latest. */
LINES_SHARED void lines_positioning_ask(struct lines_positioning *line, uint32_t node, uint32_t length,
                                        uint32_t patience_ms, uint32_t attempts, uint64_t now_ns);
LINES_SHARED void lines_positioning_take(struct lines_positioning *line, uint32_t length, uint64_t now_ns);
LINES_SHARED uint32_t lines_positioning_poll(struct lines_positioning *line, uint64_t now_ns);
LINES_SHARED uint64_t lines_positioning_until_ns(const struct lines_positioning *line);

/* What is to be written now: so many bytes; and that they have been written. */
LINES_SHARED const uint8_t *lines_positioning_out(const struct lines_positioning *line);
LINES_SHARED uint32_t lines_positioning_out_length(const struct lines_positioning *line);
LINES_SHARED void lines_positioning_note_written(struct lines_positioning *line);

/* See pos_master_answer. */
LINES_SHARED const uint8_t *lines_positioning_answer(const struct lines_positioning *line);
LINES_SHARED uint32_t lines_positioning_answer_length(const struct lines_positioning *line);

/* See pos_master_seal and pos_master_more_ms. */
LINES_SHARED uint32_t lines_positioning_seal(uint8_t *frame, uint32_t length);
LINES_SHARED uint32_t lines_positioning_more_ms(const uint8_t *request, uint32_t length);

#endif
