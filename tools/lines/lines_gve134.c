#include "lines_gve134.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "gve_master.h"

struct lines_gve134 {
    struct gve_master master;
    uint8_t heard[LINES_GVE134_HEARD_BYTES];
};

struct lines_gve134 *lines_gve134_begin(uint32_t baud, uint32_t sums)
{
    struct lines_gve134 *line = calloc(1, sizeof *line);
    if (line != NULL) {
        gve_master_init(&line->master, baud, (enum gve_master_sums)sums);
    }
    return line;
}

void lines_gve134_end(struct lines_gve134 *line)
{
    free(line);
}

uint8_t *lines_gve134_request(struct lines_gve134 *line)
{
    return line->master.text;
}

uint8_t *lines_gve134_heard(struct lines_gve134 *line)
{
    return line->heard;
}

void lines_gve134_ask(struct lines_gve134 *line, uint32_t kind, uint32_t length, uint64_t wait_ms, uint64_t now_ns)
{
    const struct gve_master_order order = {.kind = (uint8_t)kind, .length = length, .wait_ms = wait_ms};
    gve_master_begin(&line->master, &order, now_ns);
}

void lines_gve134_take(struct lines_gve134 *line, uint32_t length, uint64_t now_ns)
{
    assert(length <= LINES_GVE134_HEARD_BYTES);
    gve_master_take(&line->master, line->heard, length, now_ns);
}

uint32_t lines_gve134_poll(struct lines_gve134 *line, uint64_t now_ns)
{
    return gve_master_poll(&line->master, now_ns);
}

void lines_gve134_forget(struct lines_gve134 *line)
{
    gve_master_forget(&line->master);
}

uint64_t lines_gve134_until(const struct lines_gve134 *line)
{
    return line->master.wire.until_ns;
}

const uint8_t *lines_gve134_out(const struct lines_gve134 *line)
{
    return line->master.wire.out;
}

uint32_t lines_gve134_take_out(struct lines_gve134 *line)
{
    uint32_t length = line->master.wire.out_length;
    line->master.wire.out_length = 0;
    return length;
}

static uint32_t digit_of(const struct gve_reply *reply)
{
    return reply->code | (reply->inta ? (uint32_t)GVE_INTA : 0U);
}

uint32_t lines_gve134_digit(const struct lines_gve134 *line)
{
    return digit_of(&line->master.reply);
}

const char *lines_gve134_values(const struct lines_gve134 *line)
{
    return line->master.reply.values;
}

const char *lines_gve134_other(const struct lines_gve134 *line)
{
    return line->master.heard.other;
}

const char *lines_gve134_version(const struct lines_gve134 *line)
{
    return line->master.version;
}

uint32_t lines_gve134_repairs(const struct lines_gve134 *line)
{
    return line->master.repairs;
}

bool lines_gve134_restarted(const struct lines_gve134 *line)
{
    return line->master.restarted;
}

uint32_t lines_gve134_others(const struct lines_gve134 *line)
{
    return line->master.others;
}

bool lines_gve134_long_halt(const struct lines_gve134 *line)
{
    return line->master.long_halt;
}

uint32_t lines_gve134_encode(const uint8_t *text, uint32_t length, bool sums, uint8_t *out, uint32_t capacity)
{
    struct text put;
    text_init(&put, out, capacity);
    gve_reply_put_command(&put, text, length, sums);
    return put.length;
}

uint32_t lines_gve134_read(const uint8_t *text, uint32_t length, bool sums, char *values)
{
    struct gve_reply reply;
    if (!gve_reply_read(&reply, text, length, sums)) {
        return UINT32_MAX;
    }
    memcpy(values, reply.values, reply.length + 1U);
    return digit_of(&reply);
}
