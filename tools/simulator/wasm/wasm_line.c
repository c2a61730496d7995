#include "wasm_line.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

#include "master.h"

struct wasm_line {
    struct master master;
    uint8_t heard[WASM_LINE_HEARD_BYTES];
};

struct wasm_line *wasm_line_begin(uint32_t chance, uint32_t baud)
{
    struct wasm_line *line = calloc(1, sizeof *line);
    if (line != NULL) {
        master_init(&line->master, chance, baud);
    }
    return line;
}

uint8_t *wasm_line_request(struct wasm_line *line)
{
    return line->master.message;
}

uint8_t *wasm_line_heard(struct wasm_line *line)
{
    return line->heard;
}

void wasm_line_ask(struct wasm_line *line, uint32_t node, bool in_session, uint32_t length, uint32_t patience_ms,
                   uint32_t attempts, uint64_t now_ns)
{
    assert(node <= LINK_NODE_MAX && length >= 1 && length <= LINK_REQUEST_BYTES_MAX && attempts >= 1);
    const struct master_order order = {
        .node = (uint8_t)node,
        .in_session = in_session,
        .length = length,
        .patience_ms = patience_ms,
        .attempts = attempts,
    };
    master_ask(&line->master, &order, now_ns);
}

void wasm_line_take(struct wasm_line *line, uint32_t length, uint64_t now_ns)
{
    assert(length <= WASM_LINE_HEARD_BYTES);
    master_take(&line->master, line->heard, length, now_ns);
}

uint32_t wasm_line_poll(struct wasm_line *line, uint64_t now_ns)
{
    return master_poll(&line->master, now_ns);
}

void wasm_line_hurry(struct wasm_line *line, uint64_t now_ns)
{
    master_hurry(&line->master, now_ns);
}

void wasm_line_forget(struct wasm_line *line, uint32_t node)
{
    assert(node <= LINK_NODE_MAX);
    master_forget(&line->master, (uint8_t)node);
}

uint32_t wasm_line_sessions(const struct wasm_line *line, uint32_t node)
{
    assert(node <= LINK_NODE_MAX);
    return line->master.sessions[node];
}

const uint8_t *wasm_line_out(const struct wasm_line *line)
{
    return line->master.out;
}

uint32_t wasm_line_take_out(struct wasm_line *line)
{
    uint32_t length = line->master.out_length;
    line->master.out_length = 0;
    return length;
}

const uint8_t *wasm_line_answer(const struct wasm_line *line)
{
    return master_answer(&line->master);
}

uint32_t wasm_line_answer_length(const struct wasm_line *line)
{
    return master_answer_length(&line->master);
}
