#include "lines_gve134_executed.h"

#include <assert.h>
#include <stdlib.h>

#include "gve_executed.h"
#include "gve_wire.h"

struct lines_gve134_executed {
    struct gve_executed executed;
    uint8_t request[GVE_WIRE_TEXT_BYTES];
};

struct lines_gve134_executed *lines_gve134_executed_begin(void)
{
    return calloc(1, sizeof(struct lines_gve134_executed));
}

void lines_gve134_executed_end(struct lines_gve134_executed *line)
{
    free(line);
}

uint8_t *lines_gve134_executed_request(struct lines_gve134_executed *line)
{
    return line->request;
}

void lines_gve134_executed_start(struct lines_gve134_executed *line, int32_t x, int32_t y, int32_t z, int32_t a)
{
    gve_executed_init(&line->executed, (const int32_t[]){x, y, z, a});
}

void lines_gve134_executed_lose(struct lines_gve134_executed *line)
{
    gve_executed_lose(&line->executed);
}

void lines_gve134_executed_take(struct lines_gve134_executed *line, uint32_t length)
{
    assert(length <= (uint32_t)GVE_WIRE_TEXT_BYTES);
    gve_executed_take(&line->executed, line->request, length);
}

void lines_gve134_executed_stand(struct lines_gve134_executed *line, int32_t x, int32_t y, int32_t z, int32_t a)
{
    gve_executed_stand(&line->executed, (const int32_t[]){x, y, z, a});
}

uint32_t lines_gve134_executed_look(struct lines_gve134_executed *line, uint32_t length, int32_t x, int32_t y,
                                    int32_t z, int32_t a)
{
    assert(length <= (uint32_t)GVE_WIRE_TEXT_BYTES);
    return gve_executed_look(&line->executed, (const int32_t[]){x, y, z, a}, line->request, length);
}

uint32_t lines_gve134_executed_done(const struct lines_gve134_executed *line)
{
    return gve_executed_done(&line->executed);
}

const uint32_t *lines_gve134_executed_place(const struct lines_gve134_executed *line)
{
    return line->executed.place;
}
