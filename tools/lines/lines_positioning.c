#include "lines_positioning.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

#include "pos_master.h"

struct lines_positioning {
    struct pos_master master;
    uint8_t heard[LINES_POSITIONING_HEARD_BYTES];
};

struct lines_positioning *lines_positioning_begin(uint32_t baud, bool tcp)
{
    struct lines_positioning *line = calloc(1, sizeof *line);
    if (line != NULL) {
        pos_master_init(&line->master, baud, tcp);
    }
    return line;
}

void lines_positioning_end(struct lines_positioning *line)
{
    free(line);
}

uint8_t *lines_positioning_request(struct lines_positioning *line)
{
    return line->master.request;
}

uint8_t *lines_positioning_heard(struct lines_positioning *line)
{
    return line->heard;
}

void lines_positioning_ask(struct lines_positioning *line, uint32_t node, uint32_t length, uint32_t patience_ms,
                           uint32_t attempts, uint64_t now_ns)
{
    assert(node <= UINT8_MAX && length >= 1 && length <= POS_MASTER_REQUEST_BYTES_MAX && attempts >= 1);
    const struct pos_master_order order = {
        .node = (uint8_t)node,
        .length = length,
        .patience_ms = patience_ms,
        .attempts = attempts,
    };
    pos_master_ask(&line->master, &order, now_ns);
}

void lines_positioning_take(struct lines_positioning *line, uint32_t length, uint64_t now_ns)
{
    assert(length <= LINES_POSITIONING_HEARD_BYTES);
    pos_master_take(&line->master, line->heard, length, now_ns);
}

uint32_t lines_positioning_poll(struct lines_positioning *line, uint64_t now_ns)
{
    return pos_master_poll(&line->master, now_ns);
}

uint64_t lines_positioning_until_ns(const struct lines_positioning *line)
{
    return line->master.until_ns;
}

const uint8_t *lines_positioning_out(const struct lines_positioning *line)
{
    return line->master.sent.bytes;
}

uint32_t lines_positioning_out_length(const struct lines_positioning *line)
{
    return line->master.out_length;
}

void lines_positioning_note_written(struct lines_positioning *line)
{
    line->master.out_length = 0;
}

const uint8_t *lines_positioning_answer(const struct lines_positioning *line)
{
    return pos_master_answer(&line->master);
}

uint32_t lines_positioning_answer_length(const struct lines_positioning *line)
{
    return pos_master_answer_length(&line->master);
}

uint32_t lines_positioning_seal(uint8_t *frame, uint32_t length)
{
    return pos_master_seal(frame, length);
}

uint32_t lines_positioning_more_ms(const uint8_t *request, uint32_t length)
{
    return pos_master_more_ms(request, length);
}
