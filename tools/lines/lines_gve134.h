/*
 * The master of the line of a GVE134 unit (tools/gve134_master) for those that can hand over numbers only: the worker
 * of a page, by the module gve134-unit of WebAssembly, and tools in Python, by the shared library rkm04-lines.
 */
#ifndef LINES_GVE134_H
#define LINES_GVE134_H

#include <stdbool.h>
#include <stdint.h>

#include "lines_shared.h"

enum {
    LINES_GVE134_HEARD_BYTES = 4096
};

struct lines_gve134;

/* A line of which nothing is known; see gve_master_init, enum gve_master_sums. Null: there is not memory enough. */
LINES_SHARED struct lines_gve134 *lines_gve134_begin(uint32_t baud, uint32_t sums);

/* Null is fine. */
LINES_SHARED void lines_gve134_end(struct lines_gve134 *line);

/* Where commands are to be put: GVE_WIRE_TEXT_BYTES; and what has come: LINES_GVE134_HEARD_BYTES. */
LINES_SHARED uint8_t *lines_gve134_request(struct lines_gve134 *line);
LINES_SHARED uint8_t *lines_gve134_heard(struct lines_gve134 *line);

/* See struct gve_master_order, gve_master_begin, gve_master_take, gve_master_poll and gve_master_forget. */
LINES_SHARED void lines_gve134_ask(struct lines_gve134 *line, uint32_t kind, uint32_t length, uint64_t wait_ms,
                                   uint64_t now_ns);
LINES_SHARED void lines_gve134_take(struct lines_gve134 *line, uint32_t length, uint64_t now_ns);
LINES_SHARED uint32_t lines_gve134_poll(struct lines_gve134 *line, uint64_t now_ns);
LINES_SHARED void lines_gve134_forget(struct lines_gve134 *line);

/* When the next look is due. */
LINES_SHARED uint64_t lines_gve134_until(const struct lines_gve134 *line);

/* What is to be written now; so many bytes, of which the next call knows nothing any more. */
LINES_SHARED const uint8_t *lines_gve134_out(const struct lines_gve134 *line);
LINES_SHARED uint32_t lines_gve134_take_out(struct lines_gve134 *line);

/* The answer: its digit, which has GVE_INTA in it, and its values. Texts here end with a zero. */
LINES_SHARED uint32_t lines_gve134_digit(const struct lines_gve134 *line);
LINES_SHARED const char *lines_gve134_values(const struct lines_gve134 *line);

/* What another device has answered. */
LINES_SHARED const char *lines_gve134_other(const struct lines_gve134 *line);

/* See struct gve_master. */
LINES_SHARED const char *lines_gve134_version(const struct lines_gve134 *line);
LINES_SHARED uint32_t lines_gve134_repairs(const struct lines_gve134 *line);
LINES_SHARED bool lines_gve134_restarted(const struct lines_gve134 *line);
LINES_SHARED uint32_t lines_gve134_others(const struct lines_gve134 *line);
LINES_SHARED bool lines_gve134_long_halt(const struct lines_gve134 *line);

/* A command as the line has it, see gve_reply_put_command: so many bytes of `out`, which has room for `capacity`. */
LINES_SHARED uint32_t lines_gve134_encode(const uint8_t *text, uint32_t length, bool sums, uint8_t *out,
                                          uint32_t capacity);

/* The digit of an answer without its CR, see gve_reply_read, with its values and a zero in `values`, which has room
 * for them; UINT32_MAX: it is none. */
LINES_SHARED uint32_t lines_gve134_read(const uint8_t *text, uint32_t length, bool sums, char *values);

#endif
