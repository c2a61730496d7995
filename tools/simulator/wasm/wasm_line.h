/*
 * The master of a line (tools/master) for who can hand over numbers only, as the worker of a page. Together with
 * paced.h the functions are what the WebAssembly module rkm04-unit exports.
 */
#ifndef WASM_LINE_H
#define WASM_LINE_H

#include <stdbool.h>
#include <stdint.h>

enum {
    WASM_LINE_HEARD_BYTES = 4096
};

struct wasm_line;

/* A line without sessions; see master_init. Null: there is not memory enough. */
struct wasm_line *wasm_line_begin(uint32_t chance, uint32_t baud);

/* Where the message of a request is to be put: LINK_REQUEST_BYTES_MAX; and what has come: WASM_LINE_HEARD_BYTES. */
uint8_t *wasm_line_request(struct wasm_line *line);
uint8_t *wasm_line_heard(struct wasm_line *line);

/* See master_ask, master_take, master_poll, master_hurry and master_forget. */
void wasm_line_ask(struct wasm_line *line, uint32_t node, bool in_session, uint32_t length, uint32_t patience_ms,
                   uint32_t attempts, uint64_t now_ns);
void wasm_line_take(struct wasm_line *line, uint32_t length, uint64_t now_ns);
uint32_t wasm_line_poll(struct wasm_line *line, uint64_t now_ns);
void wasm_line_hurry(struct wasm_line *line, uint64_t now_ns);
void wasm_line_forget(struct wasm_line *line, uint32_t node);

/* How many sessions were begun with a node. */
uint32_t wasm_line_sessions(const struct wasm_line *line, uint32_t node);

/* What is to be written now; so many bytes, of which the next call knows nothing any more. */
const uint8_t *wasm_line_out(const struct wasm_line *line);
uint32_t wasm_line_take_out(struct wasm_line *line);

/* See master_answer. */
const uint8_t *wasm_line_answer(const struct wasm_line *line);
uint32_t wasm_line_answer_length(const struct wasm_line *line);

#endif
