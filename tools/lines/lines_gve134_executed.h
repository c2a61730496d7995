/*
 * How many vectors of a job are over (tools/gve134_job) for those that can hand over numbers only; see lines_gve134.h.
 * Commands are put where `request` says, positions are those of X, Y, Z and A.
 */
#ifndef LINES_GVE134_EXECUTED_H
#define LINES_GVE134_EXECUTED_H

#include <stdint.h>

#include "lines_shared.h"

struct lines_gve134_executed;

/* One that no job was started with. Null: there is not memory enough. */
LINES_SHARED struct lines_gve134_executed *lines_gve134_executed_begin(void);

/* Null is fine. */
LINES_SHARED void lines_gve134_executed_end(struct lines_gve134_executed *line);

/* Where commands are to be put, with LF between them: GVE_WIRE_TEXT_BYTES. */
LINES_SHARED uint8_t *lines_gve134_executed_request(struct lines_gve134_executed *line);

/* A job begins there; see gve_executed_init, gve_executed_lose, gve_executed_take, gve_executed_stand,
 * gve_executed_look and gve_executed_done. */
LINES_SHARED void lines_gve134_executed_start(struct lines_gve134_executed *line, int32_t x, int32_t y, int32_t z,
                                              int32_t a);
LINES_SHARED void lines_gve134_executed_lose(struct lines_gve134_executed *line);
LINES_SHARED void lines_gve134_executed_take(struct lines_gve134_executed *line, uint32_t length);
LINES_SHARED void lines_gve134_executed_stand(struct lines_gve134_executed *line, int32_t x, int32_t y, int32_t z,
                                              int32_t a);
LINES_SHARED uint32_t lines_gve134_executed_look(struct lines_gve134_executed *line, uint32_t length, int32_t x,
                                                 int32_t y, int32_t z, int32_t a);
LINES_SHARED uint32_t lines_gve134_executed_done(const struct lines_gve134_executed *line);

/* Where the first vector begins that is not over: four numbers of 32 bits. */
LINES_SHARED const uint32_t *lines_gve134_executed_place(const struct lines_gve134_executed *line);

#endif
