#include "lines_rkm04.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

#include "master.h"

struct lines_rkm04 {
    struct master master;
    uint8_t heard[LINES_RKM04_HEARD_BYTES];
};

struct lines_rkm04 *lines_rkm04_begin(uint32_t chance, uint32_t baud, uint32_t usual_ms)
{
    struct lines_rkm04 *line = calloc(1, sizeof *line);
    if (line != NULL) {
        master_init(&line->master, chance, baud, usual_ms);
    }
    return line;
}

void lines_rkm04_end(struct lines_rkm04 *line)
{
    free(line);
}

uint8_t *lines_rkm04_request(struct lines_rkm04 *line)
{
    return line->master.message;
}

uint8_t *lines_rkm04_heard(struct lines_rkm04 *line)
{
    return line->heard;
}

void lines_rkm04_ask(struct lines_rkm04 *line, uint32_t node, bool in_session, uint32_t length, uint32_t patience_ms,
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

void lines_rkm04_scan(struct lines_rkm04 *line, uint32_t node, uint32_t patience_ms, uint32_t attempts, uint64_t now_ns)
{
    assert(node != LINK_NODE_BROADCAST && node <= LINK_NODE_MAX && attempts >= 1);
    master_scan(&line->master, (uint8_t)node, patience_ms, attempts, now_ns);
}

void lines_rkm04_take(struct lines_rkm04 *line, uint32_t length, uint64_t now_ns)
{
    assert(length <= LINES_RKM04_HEARD_BYTES);
    master_take(&line->master, line->heard, length, now_ns);
}

uint32_t lines_rkm04_poll(struct lines_rkm04 *line, uint64_t now_ns)
{
    return master_poll(&line->master, now_ns);
}

uint64_t lines_rkm04_until(const struct lines_rkm04 *line)
{
    return line->master.until_ns;
}

void lines_rkm04_hurry(struct lines_rkm04 *line, uint64_t now_ns)
{
    master_hurry(&line->master, now_ns);
}

void lines_rkm04_forget(struct lines_rkm04 *line, uint32_t node)
{
    assert(node <= LINK_NODE_MAX);
    master_forget(&line->master, (uint8_t)node);
}

uint32_t lines_rkm04_sessions(const struct lines_rkm04 *line, uint32_t node)
{
    assert(node <= LINK_NODE_MAX);
    return line->master.sessions[node];
}

bool lines_rkm04_echoes(const struct lines_rkm04 *line)
{
    return line->master.echoes;
}

bool lines_rkm04_twice(const struct lines_rkm04 *line)
{
    return line->master.twice;
}

const uint8_t *lines_rkm04_out(const struct lines_rkm04 *line)
{
    return line->master.out;
}

uint32_t lines_rkm04_take_out(struct lines_rkm04 *line)
{
    uint32_t length = line->master.out_length;
    line->master.out_length = 0;
    return length;
}

const uint8_t *lines_rkm04_answer(const struct lines_rkm04 *line)
{
    return line->master.answer;
}

uint32_t lines_rkm04_answer_length(const struct lines_rkm04 *line)
{
    return line->master.answer_length;
}
