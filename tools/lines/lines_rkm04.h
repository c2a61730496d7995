/*
 * The master of a line (tools/master) for those that can hand over numbers only: the worker of a page, by the module
 * rkm04-unit of WebAssembly, and tools in Python, by the shared library rkm04-lines.
 */
#ifndef LINES_RKM04_H
#define LINES_RKM04_H

#include <stdbool.h>
#include <stdint.h>

#include "lines_shared.h"

enum {
    LINES_RKM04_HEARD_BYTES = 4096
};

struct lines_rkm04;

/* A line without sessions; see master_init. Null: there is not memory enough. */
LINES_SHARED struct lines_rkm04 *lines_rkm04_begin(uint32_t chance, uint32_t baud, uint32_t usual_ms);

/* Null is fine. */
LINES_SHARED void lines_rkm04_end(struct lines_rkm04 *line);

/* Where the message of a request is to be put: LINK_REQUEST_BYTES_MAX; and what has come: LINES_RKM04_HEARD_BYTES. */
LINES_SHARED uint8_t *lines_rkm04_request(struct lines_rkm04 *line);
LINES_SHARED uint8_t *lines_rkm04_heard(struct lines_rkm04 *line);

/* See master_ask, master_scan, master_take, master_poll, master_hurry and master_forget. */
LINES_SHARED void lines_rkm04_ask(struct lines_rkm04 *line, uint32_t node, bool in_session, uint32_t length,
                                  uint32_t patience_ms, uint32_t attempts, uint64_t now_ns);
LINES_SHARED void lines_rkm04_scan(struct lines_rkm04 *line, uint32_t node, uint32_t patience_ms, uint32_t attempts,
                                   uint64_t now_ns);
LINES_SHARED void lines_rkm04_take(struct lines_rkm04 *line, uint32_t length, uint64_t now_ns);
LINES_SHARED uint32_t lines_rkm04_poll(struct lines_rkm04 *line, uint64_t now_ns);
LINES_SHARED void lines_rkm04_hurry(struct lines_rkm04 *line, uint64_t now_ns);
LINES_SHARED void lines_rkm04_forget(struct lines_rkm04 *line, uint32_t node);

/* When lines_rkm04_poll is to be called at the latest. */
LINES_SHARED uint64_t lines_rkm04_until(const struct lines_rkm04 *line);

/* How many sessions were begun with a node. */
LINES_SHARED uint32_t lines_rkm04_sessions(const struct lines_rkm04 *line, uint32_t node);

/* Whether the adapter hears what it sends; and after a scan, whether two answers have come. */
LINES_SHARED bool lines_rkm04_echoes(const struct lines_rkm04 *line);
LINES_SHARED bool lines_rkm04_twice(const struct lines_rkm04 *line);

/* What is to be written now; so many bytes, of which the next call knows nothing any more. */
LINES_SHARED const uint8_t *lines_rkm04_out(const struct lines_rkm04 *line);
LINES_SHARED uint32_t lines_rkm04_take_out(struct lines_rkm04 *line);

/* After MASTER_ANSWERED, until the next request: the answer; none to a broadcast. */
LINES_SHARED const uint8_t *lines_rkm04_answer(const struct lines_rkm04 *line);
LINES_SHARED uint32_t lines_rkm04_answer_length(const struct lines_rkm04 *line);

#endif
